# SPDX-License-Identifier: LGPL-2.1-or-later
"""What flanges can sit on a pipe: the standards' rows as shapes, with those that look alike put together."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pipeworkbench import catalogue
from pipeworkbench.catalogue import FlangeDimensions
from pipeworkbench.pipeline import HUBBED_FLANGES, Flange
from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.groups import groups_of
from pipeworkbench.recon.vectors import as_vector

CURRENT_STANDARD = "EN 1092-1"
# share of the flanges of a type that have a raised face (form B): usual on weld necks, plates are made flat as often
RAISED_SHARE = {"01": 0.5, "05": 0.5, "11": 0.95, "12": 0.8, "13": 0.8}
# how common a type is: what cannot be seen is more likely the usual
TYPE_SHARE = {"11": 0.6, "01": 0.25, "05": 0.1, "12": 0.04, "13": 0.01}
RARE = 0.01
USUAL_PN = (16.0, 10.0, 40.0, 25.0, 6.0)  # the usual ones first: which of those that look alike is named
WITHDRAWN_SHARE = 0.5  # of the rows of withdrawn standards against those of the current one


@dataclass(frozen=True, eq=False)
class Variant:
    """One outside shape of a flange.

    ``dimensions`` is the row that stands for it, ``same`` are all rows of that shape, it included;
    ``raised`` is the height of the raised face in mm, 0 where the face is flat, ``prior`` the logarithm of how common it is.
    """

    dimensions: FlangeDimensions
    same: tuple[FlangeDimensions, ...]
    raised: float
    prior: float

    @property
    def thickness(self) -> float:
        """The plate's thickness C (mm), raised face included."""
        return float(self.dimensions.C or 0.0)

    @property
    def length(self) -> float:
        """From the face to the weld end, mm."""
        return float(self.dimensions.length or 0.0)

    @property
    def width(self) -> float:
        """The rim's, mm."""
        return self.thickness - self.raised

    @property
    def blind(self) -> bool:
        """Whether it has no pipe of its own."""
        return self.dimensions.blind

    @property
    def hubbed(self) -> bool:
        """Whether a hub, not a tapered neck, stands on the plate."""
        return self.dimensions.flange_type in HUBBED_FLANGES

    def at(self, face: Array, axis: Array, outer_diameter: float, name: str = "") -> Flange:
        """Return the flange with its sealing face at a point (3,), facing along a unit vector (3,)."""
        return flange_of(self.dimensions, face, axis, outer_diameter, name, raised=self.raised > 0)


def flange_of(dimensions: FlangeDimensions, face: Array, axis: Array, outer_diameter: float, name: str, *, raised: bool) -> Flange:
    """Return a row of the catalogue as a component, with the flanges that look the same as its equivalents.

    Parameters
    ----------
    dimensions : FlangeDimensions
        With its thickness and length known.
    face, axis : (3,) arrays
        Centre of the sealing face, mm, and the unit vector out of it.
    outer_diameter : float
        Of the pipe, mm.
    name : str
        The component's id.
    raised : bool
        Whether the face is raised.
    """
    if dimensions.C is None or dimensions.length is None:
        raise ValueError(f"{dimensions.designation} is not known completely")
    same = tuple(
        {"standard": other.standard, "flange_type": other.flange_type, "pn": float(other.pn)}
        for other in (catalogue.equivalents(dimensions) if name else ())
    )
    return Flange(
        id=name,
        face=as_vector(face),
        axis=as_vector(axis),
        outer_diameter=outer_diameter,
        dn=dimensions.dn,
        standard=dimensions.standard,
        verified=dimensions.verified,
        flange_type=dimensions.flange_type,
        pn=dimensions.pn,
        D=dimensions.D,
        C=dimensions.C,
        length=dimensions.length,
        neck_diameter=dimensions.neck_diameter,
        neck_straight=dimensions.neck_straight,
        raised_face_diameter=dimensions.raised_face_diameter if raised else None,
        raised_face_height=dimensions.raised_face_height if raised else None,
        K=dimensions.K,
        L=dimensions.L,
        bolts=dimensions.bolts,
        equivalents=same,
    )


def variants_of(rows: tuple[FlangeDimensions, ...]) -> tuple[Variant, ...]:
    """Return the shapes of rows of the catalogue; rows without thickness or length have none."""

    def alike(one: FlangeDimensions, other: FlangeDimensions) -> bool:
        return one.looks_like(other) and (one.flange_type in HUBBED_FLANGES) == (other.flange_type in HUBBED_FLANGES)

    groups = groups_of(sorted((row for row in rows if row.is_complete), key=_preference), alike)
    return tuple(variant for group in groups for variant in _forms(group))


def _forms(group: list[FlangeDimensions]) -> list[Variant]:
    """Return a shape with the face flat and, where its height is known, raised."""
    head = group[0]
    share = max(TYPE_SHARE.get(row.flange_type, RARE) * (1.0 if row.standard == CURRENT_STANDARD else WITHDRAWN_SHARE) for row in group)
    height = next((row for row in group if row.raised_face_height and row.raised_face_diameter), None)
    raised = RAISED_SHARE.get(head.flange_type, 0.5) if height is not None else 0.0
    forms = [Variant(head, tuple(group), 0.0, float(np.log(share * (1 - raised))))] if raised < 1 else []
    if height is not None and height is head:
        forms.append(Variant(head, tuple(group), float(head.raised_face_height or 0.0), float(np.log(share * raised))))
    return forms


def _preference(row: FlangeDimensions) -> tuple[bool, int, int, float]:
    """Return what rows are sorted by, so that the current standard's, the usual and the better sourced ones stand for the others."""
    usual = USUAL_PN.index(row.pn) if row.pn in USUAL_PN else len(USUAL_PN)
    return row.standard != CURRENT_STANDARD, usual, -row.verified, row.pn
