# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a person clicked: ``picks.json``, checked against the station it belongs to.

A file that is none, or names what the station does not have, is refused as a whole. A pick that cannot be a
pipe's is set aside with a sentence about what is wrong with it: the others are still worth their clicks.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal, NamedTuple

import numpy as np
from pydantic import BaseModel, Field, TypeAdapter

from pipeworkbench.errors import InputError
from pipeworkbench.files import check, read_json
from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.station import Finite, Positive, Station

SCHEMA = "pipeworkbench-picks/1"
SAME_EDGE_PX = 3.0  # two clicked edges nearer than this over their whole length are one edge clicked twice
LEAST_LENGTH_PX = 8.0  # a direction from points nearer together than this is not worth having
LARGEST_ANGLE_DEG = 45.0  # between both edges of a pipe, however near it is
MOST_ALTERNATIVES = 6  # ranked answers of a pick that a person may choose from

Point = tuple[Finite, Finite]
Edge = Annotated[list[Point], Field(min_length=1, max_length=2)]


class _PipePick(BaseModel):
    kind: Literal["pipe"]
    camera: str
    edges: tuple[Edge, Edge] | None = None
    point: Point | None = None
    diameter: Positive | Literal["free"] | None = None
    alternative: Annotated[int, Field(ge=1, le=MOST_ALTERNATIVES)] | None = None


class _FlangePick(BaseModel):
    kind: Literal["flange"]
    camera: str
    point: Point


class _Picks(BaseModel):
    schema_name: Annotated[Literal["pipeworkbench-picks/1"], Field(alias="schema")]
    picks: Annotated[list[Annotated[_PipePick | _FlangePick, Field(discriminator="kind")]], Field(min_length=1)]


@dataclass(frozen=True, eq=False)
class PipePick:
    """A pipe clicked in one image.

    ``index`` is the pick's place in its file, ``camera`` the camera's place in the station, ``edges``
    pixel coordinates: (2, 2, 2) two points on each edge, (2, 1, 2) one near each, or (1, 1, 2) one between
    them; ``diameter`` in mm where the user fixed it, "free" for a pipe of any diameter, None for one of the
    standard's; ``alternative`` which of the ranked answers the user chose, 1 for the best, None where he did not.
    """

    index: int
    camera: int
    edges: Array
    diameter: float | Literal["free"] | None = None
    alternative: int | None = None


@dataclass(frozen=True, eq=False)
class FlangePick:
    """A point (2,) on the straight edge of a flange's face in one image."""

    index: int
    camera: int
    point: Array


class FailedPick(NamedTuple):
    """A pick that gives nothing: its place in the file and why, a sentence without a full stop."""

    pick: int
    reason: str


@dataclass(frozen=True, eq=False)
class Picks:
    """All picks of a station, by kind; ``refused`` are those that cannot be a pipe's or a flange's."""

    pipes: tuple[PipePick, ...]
    flanges: tuple[FlangePick, ...]
    refused: tuple[FailedPick, ...] = ()


def read_picks(path: Path, station: Station) -> Picks:
    """Read ``picks.json`` and check it against its station.

    Raises
    ------
    InputError
        Where the file does not fit its schema or the station. Single picks that cannot be right are in
        ``refused``.
    """
    return picks_from(read_json(path), station, path)


def picks_from(data: Any, station: Station, source: object = "picks") -> Picks:
    """Check the structure of a picks file against its station; raise InputError where it does not fit."""
    if not isinstance(data, dict):
        raise InputError(source, "", "is not a JSON object", f"give a file of schema {SCHEMA}")
    named = data.get("station")
    if named is not None and named != station.name:
        raise InputError(source, "station", f"is '{named}' but the station is '{station.name}'", "give the picks of this station")
    if data.get("picks") == []:
        raise InputError(source, "picks", "the list is empty", "click the edges of at least one pipe")
    file = check(TypeAdapter(_Picks), data, source)
    pipes: list[PipePick] = []
    flanges: list[FlangePick] = []
    refused: list[FailedPick] = []
    for index, pick in enumerate(file.picks):
        camera = station.camera_index(pick.camera)
        if camera is None:
            names = ", ".join(c.name for c in station.cameras)
            raise InputError(source, f"picks[{index}].camera", f"no camera '{pick.camera}'", f"use one of {names}")
        points = _clicks_of(pick, index, source) if isinstance(pick, _PipePick) else np.array(pick.point, float)
        problem = _outside(points, station, camera)
        if isinstance(pick, _PipePick):
            clicked = PipePick(index, camera, points, pick.diameter, pick.alternative)
            problem = problem or _problem_of(clicked) or _repeated(clicked, pipes)
            if not problem:
                pipes.append(clicked)
        elif not problem:
            flanges.append(FlangePick(index, camera, points))
        if problem:
            refused.append(FailedPick(index, problem))
    return Picks(tuple(pipes), tuple(flanges), tuple(refused))


def _clicks_of(pick: _PipePick, index: int, source: object) -> Array:
    """Return what was clicked (edges, points, 2)."""
    if pick.edges is None and pick.point is None:
        raise InputError(source, f"picks[{index}].edges", "is missing", "click near both edges of the pipe, or once between them")
    if pick.edges is None:
        return np.array(pick.point, float).reshape(1, 1, 2)
    if len({len(edge) for edge in pick.edges}) > 1:
        raise InputError(source, f"picks[{index}].edges", "one edge has one point and the other two", "give as many points on either edge")
    return np.array(pick.edges, float)


def _outside(points: Array, station: Station, camera: int) -> str:
    """Return what is wrong where a point is not in its image, or nothing."""
    inside = station.cameras[camera].sees(points.reshape(-1, 2))
    if inside.all():
        return ""
    u, v = points.reshape(-1, 2)[~inside][0]
    size = station.cameras[camera].interior
    return f"the point ({u:g}, {v:g}) is outside the image of {size.width} x {size.height} pixels; click inside the image"


def _problem_of(pick: PipePick) -> str:
    """Return why two clicked edges cannot be those of one pipe, or nothing."""
    if pick.edges.shape[:2] == (2, 1):
        apart = float(np.linalg.norm(pick.edges[1, 0] - pick.edges[0, 0]))
        return "" if apart >= SAME_EDGE_PX else f"the points are only {apart:.1f} px apart; click one edge on each side of the pipe"
    return _problem_of_edges(pick.edges) if len(pick.edges) == 2 else ""


def _problem_of_edges(edges: Array) -> str:
    lengths = np.linalg.norm(edges[:, 1] - edges[:, 0], axis=1)
    if lengths.min() < LEAST_LENGTH_PX:
        return f"the points of edges[{int(lengths.argmin())}] are only {lengths.min():.1f} px apart; click two points far apart on the edge"
    if _same_edge(edges[0], edges[1]):
        return "both edges are the same edge; click one edge on each side of the pipe"
    directions = (edges[:, 1] - edges[:, 0]) / lengths[:, None]
    if abs(directions[0] @ directions[1]) < np.cos(np.radians(LARGEST_ANGLE_DEG)):
        return f"the edges are not the two sides of one pipe (more than {LARGEST_ANGLE_DEG:g} deg apart); click along the pipe on both sides"
    if _cross(edges, directions):
        return "the edges cross each other, as the two sides of a pipe never do; click the two points of each edge on one side of the pipe"
    return ""


def _cross(edges: Array, directions: Array) -> bool:
    """Tell whether the lines of two edges (2, 2, 2) meet beside what was clicked of them."""
    along = directions[0] + directions[1] * np.sign(directions[0] @ directions[1])
    along /= np.linalg.norm(along)
    across = np.array([-along[1], along[0]])
    ends = np.array([(edges @ along).min(), (edges @ along).max()])
    places, offsets = edges @ along, edges @ across
    slopes = np.diff(offsets, axis=1) / np.diff(places, axis=1)
    apart = np.diff(offsets[:, :1] + slopes * (ends - places[:, :1]), axis=0)[0]
    # a slip of the hand turns short edges: only what is clearly on the other side counts
    return bool(apart[0] * apart[1] < 0 and np.abs(apart).min() > SAME_EDGE_PX)


def _repeated(pick: PipePick, earlier: Sequence[PipePick]) -> str:
    """Return which pick has the same two edges, or nothing."""
    for other in earlier:
        if pick.camera != other.camera or not pick.edges.shape == other.edges.shape == (2, 2, 2):
            continue
        for order in ((0, 1), (1, 0)):
            if all(_same_edge(pick.edges[i], other.edges[j]) for i, j in zip((0, 1), order, strict=True)):
                return f"the edges are the same as those of picks[{other.index}]; remove one of the two picks"
    return ""


def _same_edge(one: Array, other: Array) -> bool:
    """Tell whether two clicked edges (2, 2) lie on one line and overlap."""
    direction = (other[1] - other[0]) / np.linalg.norm(other[1] - other[0])
    offset = one - other[0]
    across = np.abs(offset[:, 0] * direction[1] - offset[:, 1] * direction[0])
    along = np.sort(offset @ direction)
    overlap = min(along[1], float(np.linalg.norm(other[1] - other[0]))) - max(along[0], 0.0)
    return bool(across.max() < SAME_EDGE_PX and overlap > 0)
