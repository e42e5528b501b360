# SPDX-License-Identifier: LGPL-2.1-or-later
"""How a component is insulated: layers, jacket, seams and the ways bends, flanges and tees are built."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Annotated, Literal

from annotated_types import Ge, Gt, Le, MinLen

from pipeworkbench.pipeline import NotNegative, Positive
from pipeworkbench.solids.coverings import Layer, Sheet

# what is beyond was not meant, or was not given in mm
LARGEST_RIVET = 10.0
LARGEST_BEAD = 100.0
LARGEST_CLEARANCE = 1000.0
LARGEST_SHEET = 1e6
MOST_GORES = 1000


@dataclass(frozen=True)
class Seams:
    """Overlaps and fixings of the jacket (mm).

    ``longitudinal_overlap`` is added along a jacket's length seam, ``circumferential_overlap`` at the one end that goes
    over the neighbouring piece; ``rivet_pitch`` is the distance of rivet holes along the seams (0: none), ``rivet_diameter``
    their diameter. ``bead`` marks the beads along the circumferential edges, ``bead_allowance`` is what the sheet shrinks by for each.
    """

    longitudinal_overlap: NotNegative = 30.0
    circumferential_overlap: NotNegative = 50.0
    gore_overlap: NotNegative = 10.0
    rivet_pitch: NotNegative = 150.0
    rivet_diameter: Annotated[Positive, Le(LARGEST_RIVET)] = 4.1
    bead: bool = False
    bead_allowance: Annotated[NotNegative, Le(LARGEST_BEAD)] = 3.0
    stagger_deg: Annotated[NotNegative, Le(180)] = 30.0


@dataclass(frozen=True)
class Bends:
    """How elbows are built.

    ``shape`` "segmented" or "smooth" (a torus, as of foam shells); ``gores`` the number of pieces, by rule where it is None;
    ``first_gore`` "half" as long as the others, "equal" to them, or by so many mm longer than the half; ``tight`` says what
    is done where the insulation is thicker than the bend's radius allows: one "mitre" joint of two pieces, or "refuse".
    """

    shape: Literal["segmented", "smooth"] = "segmented"
    gores: Annotated[int, Ge(2), Le(MOST_GORES)] | None = None
    first_gore: Literal["half", "equal"] | NotNegative = "half"
    tight: Literal["mitre", "refuse"] = "mitre"


@dataclass(frozen=True)
class Flanges:
    """How flanges and what lies between two of them are covered.

    ``cover`` "box" (two half shells) or "bare"; ``clearance`` (mm) is between the flange's rim and the box's hollow;
    ``gap`` (mm) is added to the bolt's length between a flange's back and the pipe's insulation, so that the bolts can be
    pulled; ``overlap`` (mm) is how far the box reaches over the pipe's jacket; ``longest_valve`` (mm) is the distance up to
    which two faces that look at each other are taken for the ends of one valve under one box.
    """

    cover: Literal["box", "bare"] = "box"
    clearance: Annotated[NotNegative, Le(LARGEST_CLEARANCE)] = 20.0
    gap: NotNegative = 30.0
    overlap: NotNegative = 50.0
    longest_valve: NotNegative = 1200.0


@dataclass(frozen=True)
class Treatment:
    """All that is said of a component's insulation."""

    layers: Annotated[tuple[Layer, ...], MinLen(1)]
    jacket: Sheet | None = None
    seams: Seams = field(default_factory=Seams)
    bends: Bends = field(default_factory=Bends)
    flanges: Flanges = field(default_factory=Flanges)
    remarks: tuple[str, ...] = ()

    @property
    def thickness(self) -> float:
        """Thickness (mm) of all layers without the jacket."""
        return sum(layer.thickness for layer in self.layers)


@dataclass(frozen=True)
class SheetSize:
    """A sheet or coil to cut from (mm); the grain runs along its width."""

    width: Annotated[float, Gt(0), Le(LARGEST_SHEET)] = 2000.0
    height: Annotated[float, Gt(0), Le(LARGEST_SHEET)] = 1000.0
    margin: NotNegative = 10.0
    spacing: NotNegative = 5.0

    def __post_init__(self) -> None:
        side = min(self.width, self.height)
        if 2 * self.margin >= side:
            raise ValueError(f"margins of {self.margin:g} mm leave nothing of {side:g} mm: give less than {side / 2:g}")
