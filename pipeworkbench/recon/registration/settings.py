# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tunables of the registration of several stations."""

from __future__ import annotations

from dataclasses import dataclass, field


@dataclass(frozen=True)
class SearchSettings:
    """Tunables of the search for corresponding components (Sect. 8.1).

    Likeness: ``diameter`` and ``second_size`` are relative differences, ``bend_deg`` the difference of elbows' angles, ``inclination_deg``
    and ``direction_deg`` those of axes before and after the heading is known: the tilt that the inclination sensors leave (0.5 degrees
    per station) and twice the paper's largest direction deviation (Table 4: 0.6 degrees; flanges, Table 7: 2.1 degrees).

    Hypotheses: headings are counted in steps of ``heading_step_deg``, at most ``headings`` of them are tried; two axes that
    include at least ``crossing_deg`` fix a translation, if they pass each other alike within ``skew`` mm; of the ``rarest`` axes per
    heading at most; translations within ``cell`` mm are one, and the ``translations`` with most votes per heading are looked at.

    Verification: a component is explained within ``coarse`` mm plus ``coarse_slope`` per mm from the middle of all
    (the tilt turns about it); the best ``refined`` hypotheses are adjusted while the tolerance shrinks through ``ranges`` mm; then within
    ``sigmas`` standard deviations, which are at least ``floor_mm`` and ``floor_deg``, and never more than ``most_mm``.

    Judgement: a pose is accepted from ``least_score`` and ``least_pairs`` on, if it explains ``least_share`` of the smaller
    station's components or more; the less it explains the more it must, up to ``certain_score``: plants of bench/register.py that have
    nothing in common reach 5, of 100 components 8. Poses that move any component by more than ``distinct`` mm are different; it is
    ambiguous where a different pose scores within ``margin`` or ``margin_share`` of the best.
    """

    diameter: float = 0.02
    second_size: float = 0.03
    bend_deg: float = 4.0
    inclination_deg: float = 3.0
    direction_deg: float = 4.0
    heading_step_deg: float = 1.0
    headings: int = 12
    crossing_deg: float = 25.0
    skew: float = 60.0
    rarest: int = 120
    cell: float = 80.0
    translations: int = 60
    coarse: float = 40.0
    coarse_slope: float = 0.02
    refined: int = 40
    ranges: tuple[float, ...] = (120.0, 60.0, 40.0, 25.0, 25.0)
    sigmas: float = 4.0
    floor_mm: float = 1.0
    floor_deg: float = 0.1
    most_mm: float = 30.0
    least_score: float = 2.8
    least_pairs: int = 3
    least_share: float = 0.5
    certain_score: float = 10.0
    distinct: float = 60.0
    margin: float = 0.8
    margin_share: float = 0.08


@dataclass(frozen=True)
class NetworkSettings:
    """Tunables of the adjustment of all stations' poses (Sect. 8.3).

    ``tukey`` and ``huber`` are factors of the robust standard deviation of the pairs' normalised distances; ``tilt_deg`` is the standard
    deviation of a station's inclination sensor, None where stations are not level; ``control_sigma`` mm that of a control point that says
    nothing of itself; ``outlier`` the normalised distance from which a pair is marked. The adjustment ends below ``step`` mm or after
    ``iterations``; a pose is undetermined where a direction's standard deviation is above ``slide`` mm or the rotation's above ``turn_deg``.
    ``rounds`` is how often correspondences are looked for anew with the adjusted poses.
    """

    huber: float = 1.5
    tukey: float = 4.7
    tilt_deg: float | None = 0.5
    control_sigma: float = 0.5
    outlier: float = 4.0
    step: float = 1e-4
    iterations: int = 40
    slide: float = 25.0
    turn_deg: float = 2.0
    rounds: int = 2


@dataclass(frozen=True)
class FusionSettings:
    """Tunables of the fusion of what several stations saw.

    Two pipes are one where their axes lie within ``aside`` diameters and ``direction_deg`` of each other and overlap, or are apart along
    the axis by at most ``gap`` diameters (``gap_mm`` at most) with nothing joined between. ``anchor`` diameters (``anchor_mm`` at least)
    is the distance of fittings that are one.
    """

    aside: float = 0.5
    direction_deg: float = 6.0
    gap: float = 2.0
    gap_mm: float = 150.0
    anchor: float = 0.5
    anchor_mm: float = 20.0


@dataclass(frozen=True)
class RegistrationSettings:
    """Tunables of each step."""

    search: SearchSettings = field(default_factory=SearchSettings)
    adjustment: NetworkSettings = field(default_factory=NetworkSettings)
    fusion: FusionSettings = field(default_factory=FusionSettings)
