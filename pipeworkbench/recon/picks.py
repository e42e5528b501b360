# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a person clicked: ``picks.json``, checked against the station it belongs to."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import BaseModel, Field, TypeAdapter

from pipeworkbench.errors import InputError
from pipeworkbench.files import check, read_json
from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.station import Finite, Positive, Station

SCHEMA = "pipeworkbench-picks/1"
SAME_EDGE_PX = 3.0  # two clicked edges nearer than this over their whole length are one edge clicked twice
LEAST_LENGTH_PX = 8.0  # a direction from points nearer together than this is not worth having

Point = tuple[Finite, Finite]
Edge = Annotated[list[Point], Field(min_length=1, max_length=2)]


class _PipePick(BaseModel):
    kind: Literal["pipe"]
    camera: str
    edges: tuple[Edge, Edge] | None = None
    point: Point | None = None
    diameter: Positive | Literal["free"] | None = None


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
    pixel coordinates: (2, 2, 2) two points on each edge, or (2, 1, 2) one near each; ``diameter`` in mm where the user fixed it, "free" for
    a pipe of any diameter, None for one of the standard's.
    """

    index: int
    camera: int
    edges: Array
    diameter: float | Literal["free"] | None = None


@dataclass(frozen=True, eq=False)
class FlangePick:
    """A point (2,) on the straight edge of a flange's face in one image."""

    index: int
    camera: int
    point: Array


@dataclass(frozen=True, eq=False)
class Picks:
    """All picks of a station, by kind."""

    pipes: tuple[PipePick, ...]
    flanges: tuple[FlangePick, ...]


def read_picks(path: Path, station: Station) -> Picks:
    """Read ``picks.json`` and check it against its station.

    Raises
    ------
    InputError
        Where the file does not fit, a pick lies outside its image, or one edge was clicked twice.
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
    pipes, flanges = [], []
    for index, pick in enumerate(file.picks):
        camera = station.camera_index(pick.camera)
        if camera is None:
            names = ", ".join(c.name for c in station.cameras)
            raise InputError(source, f"picks[{index}].camera", f"no camera '{pick.camera}'", f"use one of {names}")
        points = _clicks_of(pick, index, source) if isinstance(pick, _PipePick) else np.array(pick.point, float)
        _refuse_outside(points, station, camera, f"picks[{index}]", source)
        if isinstance(pick, _PipePick):
            pipes.append(PipePick(index, camera, points, pick.diameter))
            if points.shape == (2, 2, 2):
                _refuse_poor_edges(pipes[-1], source)
            else:
                _refuse_same_point(points, index, source)
        else:
            flanges.append(FlangePick(index, camera, points))
    _refuse_repeated(pipes, source)
    return Picks(tuple(pipes), tuple(flanges))


def _clicks_of(pick: _PipePick, index: int, source: object) -> Array:
    """Return what was clicked (edges, points, 2)."""
    if pick.edges is None:
        what = "is missing" if pick.point is None else "is missing: one point inside the pipe is not understood yet"
        raise InputError(source, f"picks[{index}].edges", what, "click near both edges of the pipe, once or twice each")
    if len({len(edge) for edge in pick.edges}) > 1:
        raise InputError(source, f"picks[{index}].edges", "one edge has one point and the other two", "give as many points on either edge")
    return np.array(pick.edges, float)


def _refuse_same_point(points: Array, index: int, source: object) -> None:
    apart = float(np.linalg.norm(points[1, 0] - points[0, 0]))
    if apart < SAME_EDGE_PX:
        raise InputError(source, f"picks[{index}].edges", f"the points are only {apart:.1f} px apart", "click one edge on each side of the pipe")


def _refuse_outside(points: Array, station: Station, camera: int, key: str, source: object) -> None:
    inside = station.cameras[camera].sees(points.reshape(-1, 2))
    if not inside.all():
        u, v = points.reshape(-1, 2)[~inside][0]
        size = station.cameras[camera].interior
        raise InputError(
            source,
            key,
            f"the point ({u:g}, {v:g}) is outside the image of {size.width} x {size.height} pixels",
            "click inside the image",
        )


def _refuse_poor_edges(pick: PipePick, source: object) -> None:
    key = f"picks[{pick.index}].edges"
    lengths = np.linalg.norm(pick.edges[:, 1] - pick.edges[:, 0], axis=1)
    if lengths.min() < LEAST_LENGTH_PX:
        where = f"{key}[{int(lengths.argmin())}]"
        raise InputError(source, where, f"its points are only {lengths.min():.1f} px apart", "click two points far apart on the edge")
    if _same_edge(pick.edges[0], pick.edges[1]):
        raise InputError(source, key, "both edges are the same edge", "click one edge on each side of the pipe")
    directions = (pick.edges[:, 1] - pick.edges[:, 0]) / lengths[:, None]
    if abs(directions[0] @ directions[1]) < np.cos(np.radians(45)):
        raise InputError(source, key, "the edges are not the two sides of one pipe (more than 45 deg apart)", "click along the pipe on both sides")


def _refuse_repeated(pipes: Sequence[PipePick], source: object) -> None:
    """Refuse a pipe that was picked twice: both its edges are another pick's edges."""
    whole = [pick for pick in pipes if pick.edges.shape == (2, 2, 2)]
    for number, later in enumerate(whole):
        for earlier in whole[:number]:
            if later.camera != earlier.camera:
                continue
            for order in ((0, 1), (1, 0)):
                if all(_same_edge(later.edges[i], earlier.edges[j]) for i, j in zip((0, 1), order, strict=True)):
                    raise InputError(
                        source,
                        f"picks[{later.index}].edges",
                        f"are the same edges as those of picks[{earlier.index}]",
                        "remove one of the two picks",
                    )


def _same_edge(one: Array, other: Array) -> bool:
    """Tell whether two clicked edges (2, 2) lie on one line and overlap."""
    direction = (other[1] - other[0]) / np.linalg.norm(other[1] - other[0])
    offset = one - other[0]
    across = np.abs(offset[:, 0] * direction[1] - offset[:, 1] * direction[0])
    along = np.sort(offset @ direction)
    overlap = min(along[1], float(np.linalg.norm(other[1] - other[0]))) - max(along[0], 0.0)
    return bool(across.max() < SAME_EDGE_PX and overlap > 0)
