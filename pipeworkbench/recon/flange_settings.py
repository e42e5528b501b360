# SPDX-License-Identifier: LGPL-2.1-or-later
"""The tunables of finding flanges, in one place."""

from __future__ import annotations

from dataclasses import dataclass, field

from pipeworkbench.recon.flange_weighing import WeighingSettings
from pipeworkbench.recon.rim_profile import LikelihoodSettings


@dataclass(frozen=True)
class FlangeSettings:
    """Tunables; lengths in mm unless they end in px.

    Where rims are looked for: at places ``step_px`` apart along the axis, at most ``most_places`` (``most_places_along`` a whole
    line without a click); ``gaps`` between the faces of a pair (a gasket of about 2 mm); two edges nearer than ``apart_px``
    are one in the image. Of each form of rim the best ``peaks`` (``peaks_along``), ``apart`` from each other, are kept.

    What is weighed: the best ``rims`` of all with ``rim_share`` of the best one's score (``form_share`` before partners are
    looked for), at most ``hypotheses``; the best ``again`` once more where they came to lie more than ``again_off`` off the axis.

    What counts: a partner's rim must be likelier than chance by ``partner_margin`` and by ``partner_share`` of the flange's own;
    a flange by ``least_score`` (``least_score_without_click``; a rim by ``least_rim``, those within ``cluster`` being told
    apart), with q of its own contours up to ``largest_quality_px``
    (``largest_quality_without_click_px``). ``coverage`` is the weight of which side of a flange its
    pipe was seen on, between ``near`` and ``far`` from it. Against a blind flange speak ``blind_alone`` where it is bolted to
    nothing and ``blind_pipe`` where a pipe runs on behind it, for more than the part ``overrun`` that an end may be wrong by.

    A click lies within ``click_reach_px`` of the rim, with a standard deviation of ``click_sigma_px``; its flange lies up to
    ``beyond`` past the pipe's known ends, and the ray may pass ``off_axis`` outside the largest rim; so many ``pipes`` are tried.
    Pipes within ``collinear_deg`` and ``collinear_mm`` are one line.
    """

    gaps: tuple[float, float] = (1.0, 4.0)
    step_px: float = 0.8
    most_places: int = 500
    rims: int = 5
    form_share: float = 0.3
    rim_share: float = 0.5
    hypotheses: int = 14
    again: int = 8
    again_off: float = 1.5
    peaks: int = 3
    apart: float = 2.5
    apart_px: float = 4.0
    partner_margin: float = 6.0
    partner_share: float = 0.35
    least_score: float = 40.0
    largest_quality_px: float = 0.9
    coverage: float = 3.0
    near: float = 30.0
    far: float = 180.0
    blind_pipe: float = 40.0
    blind_alone: float = 12.0
    overrun: float = 0.35
    beyond: float = 400.0
    click_reach_px: float = 9.0
    click_sigma_px: float = 3.0
    off_axis: float = 12.0
    pipes: int = 3
    peaks_along: int = 12
    most_places_along: int = 3000
    least_rim: float = 40.0
    cluster: float = 60.0
    least_score_without_click: float = 70.0
    largest_quality_without_click_px: float = 0.8
    collinear_deg: float = 2.0
    collinear_mm: float = 15.0
    weighing: WeighingSettings = field(default_factory=WeighingSettings)
    likelihood: LikelihoodSettings = field(default_factory=LikelihoodSettings)
