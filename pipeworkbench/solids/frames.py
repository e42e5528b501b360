# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where the axes lie that a component is modelled in.

================ ================== ========================== ====================================
component        origin             z                          x
================ ================== ========================== ====================================
pipe, cap        start              along the axis             upwards, as far as it is across z
elbow            start              into the bend              towards the centre of the bend
flange           centre of the face from the face to its back  upwards, as far as it is across z
tee              intersection       along the run              towards the branch, across z
reducer          the wide end       along the axis             towards the other end's offset
================ ================== ========================== ====================================
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pipeworkbench.errors import InputError
from pipeworkbench.pipeline import AnyComponent, Cap, Elbow, Flange, Matrix, Pipe, Reducer, Tee, Vector
from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.vectors import across, angle_between

UP = (0.0, 0.0, 1.0)  # of a levelled station's frame
SAME_DIRECTION = 1e-6  # sine of the angle below which two directions count as parallel
SAME_POINT_MM = 1e-6


@dataclass(frozen=True, eq=False)
class Frame:
    """A component's own axes in the pipeline's frame: ``origin`` (3,) mm, orthonormal right-handed ``x``, ``y``, ``z`` (3,)."""

    origin: Array
    x: Array
    y: Array
    z: Array

    @property
    def matrix(self) -> Matrix:
        """The 4 x 4 motion from the component's own axes to the pipeline's frame."""
        rows = np.column_stack([self.x, self.y, self.z, self.origin]).tolist()
        return (*(tuple(row) for row in rows), (0.0, 0.0, 0.0, 1.0))

    @property
    def inverse(self) -> Matrix:
        """The 4 x 4 motion from the pipeline's frame to the component's own axes."""
        rotation = np.array([self.x, self.y, self.z])
        rows = np.column_stack([rotation, -rotation @ self.origin]).tolist()
        return (*(tuple(row) for row in rows), (0.0, 0.0, 0.0, 1.0))


IDENTITY = Frame(np.zeros(3), *np.eye(3))


def frame_of(component: AnyComponent) -> Frame:
    """Return a component's own axes.

    Raises
    ------
    InputError
        Where the component's points leave a direction open.
    """
    key, towards = "axis", np.array(UP)
    match component:
        case Pipe():
            origin, z = np.array(component.start), np.subtract(component.end, component.start)
        case Elbow():
            origin, z = np.array(component.start), np.subtract(component.intersection, component.start)
            key, towards = "intersection", np.subtract(component.end, component.intersection)
        case Flange():
            # bolt holes straddle the vertical (EN 1092-1), which x therefore follows
            origin, z = np.array(component.face), -np.array(component.axis)
        case Tee():
            origin, z = np.array(component.intersection), np.subtract(component.end, component.start)
            key, towards = "branch_end", np.subtract(component.branch_end, component.intersection)
        case Reducer():
            origin, z = np.array(component.start), np.array(component.axis)
            offset = np.subtract(component.end, component.start)
            offset = offset - (offset @ z) * z / max(float(z @ z), SAME_POINT_MM)
            towards = offset if np.linalg.norm(offset) > SAME_POINT_MM else towards
        case Cap():
            origin, z = np.array(component.start), np.array(component.axis)
    return _frame(component.id, key, origin, z, towards, must_differ=isinstance(component, Elbow | Tee))


def _frame(name: str, key: str, origin: Array, z: Array, towards: Array, *, must_differ: bool) -> Frame:
    lengths = float(np.linalg.norm(z)), float(np.linalg.norm(towards))
    if min(lengths) <= SAME_POINT_MM:
        raise InputError(name, key, "two points or directions that must differ are the same", "correct the component's points")
    z, towards = z / lengths[0], towards / lengths[1]
    x = across(towards, z)
    if np.linalg.norm(x) <= SAME_DIRECTION:
        if must_differ:
            raise InputError(name, key, "both axes are parallel", "leave the component out: the pipes meet in a line")
        # a vertical axis: any direction across it will do, the frame's x is one that stays put
        x = np.array((1.0, 0.0, 0.0)) - z[0] * z
    x = x / np.linalg.norm(x)
    return Frame(origin, x, np.cross(z, x), z)


def bend_angle(elbow: Elbow) -> float:
    """Return the angle (rad) between an elbow's axes, from its points."""
    come, go = np.subtract(elbow.intersection, elbow.start), np.subtract(elbow.end, elbow.intersection)
    return angle_between(come, go)


def local_point(frame: Frame, point: Vector) -> Array:
    """Return a point (3,) of the pipeline's frame in a component's own axes."""
    return np.array([frame.x, frame.y, frame.z]) @ (np.array(point) - frame.origin)
