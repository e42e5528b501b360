# SPDX-License-Identifier: LGPL-2.1-or-later
"""One pipe being measured: from clicks over the answers of the images to the component. A state machine that knows neither Qt nor FreeCAD.

Whoever shows it runs what ``request`` asks for (in a thread), hands back what is seen, and draws what ``shown`` says.
"""

from __future__ import annotations

import enum
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Literal

from pipeworkbench.catalogue import pipe_size

if TYPE_CHECKING:
    from pipeworkbench.pipeline import Pipe
    from pipeworkbench.recon.camera import Array
    from pipeworkbench.recon.candidates import PipeCandidate
    from pipeworkbench.recon.edges import EdgeMap
    from pipeworkbench.recon.picks import PipePick
    from pipeworkbench.recon.pipes import PickAnswer, Sighting
    from pipeworkbench.recon.snapping import SnappedEdge
    from pipeworkbench.recon.station import Station

Diameter = float | Literal["free"] | None
CLICKED = "clicked"  # key of a component under which its clicks are kept, as an entry of picks.json


class State(enum.Enum):
    """Where a measurement stands."""

    EMPTY = enum.auto()
    ONE_EDGE = enum.auto()
    MEASURING = enum.auto()
    ANSWERED = enum.auto()
    FAILED = enum.auto()


class ClickMode(enum.Enum):
    """What a click means: an edge where the pointer snapped to one and the pipe's inside elsewhere, or always one of them."""

    AUTOMATIC = enum.auto()
    INSIDE = enum.auto()
    EDGES = enum.auto()


@dataclass(frozen=True, eq=False)
class Touch:
    """A click: the point (2,) in pixels and the edge that the pointer snapped to."""

    point: Array
    edge: SnappedEdge | None


@dataclass(frozen=True, eq=False)
class Request:
    """A pick whose answer is wanted; what comes back for an older one is no longer of interest."""

    pick: PipePick


class PipeMeasurement:
    """The clicks, the answers and the choice among them.

    Parameters
    ----------
    station : Station
    pick_index : int
        Of the pick, which names the pipe.

    Attributes
    ----------
    camera : str or None
        Name of the camera that was clicked in.
    touches : list of Touch
    reason : str
        Why there is no answer, or none that is sure: a sentence; empty where all is well.
    answers : list of PipeCandidate
        What the pick could mean, the likeliest first; it grows while measuring.
    """

    def __init__(self, station: Station, pick_index: int) -> None:
        self.station = station
        self.pick_index = pick_index
        self.mode = ClickMode.AUTOMATIC
        self.diameter: Diameter = None
        self.camera: str | None = None
        self.touches: list[Touch] = []
        self.reason = ""
        self.answers: list[PipeCandidate] = []
        self._entry: dict[str, Any] | None = None
        self._request: Request | None = None
        self._is_measuring = False
        self._guess: Pipe | None = None
        self._tried: Pipe | None = None
        self._row = 0
        self._chosen_by_user = False

    @property
    def state(self) -> State:
        """Where the measurement stands."""
        if self.answers:
            return State.ANSWERED
        if self._is_measuring:
            return State.MEASURING
        if self._entry is not None:
            return State.FAILED
        return State.ONE_EDGE if self.touches else State.EMPTY

    @property
    def is_measuring(self) -> bool:
        """Whether more answers may come."""
        return self._is_measuring

    @property
    def row(self) -> int:
        """Which of the answers is chosen."""
        return self._row

    @property
    def request(self) -> Request | None:
        """The pick that is to be measured, None where there is none."""
        return self._request if self._is_measuring else None

    def click(self, camera: str, point: tuple[float, float], edge: SnappedEdge | None, edges: EdgeMap | None = None) -> None:
        """Take a click in a photograph.

        Parameters
        ----------
        camera : str
        point : (u, v)
            Pixels.
        edge : SnappedEdge or None
            What the pointer snapped to.
        edges : EdgeMap, optional
            Of the photograph, to follow clicked edges along.
        """
        import numpy as np

        if self.state is not State.ONE_EDGE:
            self.restart()
        on_edge = self.touches or (edge is not None if self.mode is ClickMode.AUTOMATIC else self.mode is ClickMode.EDGES)
        touch = Touch(np.array(edge.point if edge is not None and on_edge else point, float), edge if on_edge else None)
        self.reason = ""
        if self.touches and camera != self.camera:
            self.touches = []
            self.reason = "both edges are clicked in the same photograph; click the pipe's other edge in this one"
        self.camera = camera
        self.touches.append(touch)
        if not on_edge:
            self._measure({"kind": "pipe", "camera": camera, "point": touch.point.tolist()})
        elif len(self.touches) == 2:
            self._measure({"kind": "pipe", "camera": camera, "edges": self._clicked_edges(edges)})

    def repeat(self, entry: dict[str, Any]) -> None:
        """Take the clicks of a pipe that was measured before, an entry as in picks.json."""
        import numpy as np

        self.restart()
        self.camera = entry["camera"]
        self.diameter = entry.get("diameter")
        points = [entry["point"]] if "point" in entry else [np.mean(edge, axis=0) for edge in entry["edges"]]
        self.touches = [Touch(np.array(point, float), None) for point in points]
        self._measure({key: value for key, value in entry.items() if key != "diameter"})

    def set_diameter(self, diameter: Diameter) -> None:
        """Ask for a diameter in mm, a free one ("free") or one of the standard (None); what was clicked is measured again."""
        if diameter == self.diameter:
            return
        self.diameter = diameter
        if self._entry is not None:
            self._measure(self._entry)

    def sighted(self, request: Request, sighting: Sighting) -> None:
        """Take what is seen before the answer."""
        if request is not self.request:
            return
        if sighting.candidate is None:
            self._guess = self._pipe(sighting.ends, sighting.diameter)
        else:
            self._add(sighting.candidate)

    def answered(self, request: Request, answer: PickAnswer) -> None:
        """Take the answer; the user's choice among what was seen already stays."""
        if request is not self.request:
            return
        self._is_measuring = False
        chosen = self.answers[self._row] if self.answers and self._chosen_by_user else answer.chosen
        self.answers = list(answer.ranked)
        self.reason = answer.reason
        self._row = next((row for row, one in enumerate(self.answers) if one is chosen or _is_same(one, chosen)), 0)

    def failed(self, request: Request, reason: str) -> None:
        """Take that there is no answer."""
        if request is self.request:
            self._is_measuring = False
            self.reason = reason

    def choose(self, row: int) -> bool:
        """Choose one of the answers; whether there is such a one."""
        if not 0 <= row < len(self.answers):
            return False
        self._row, self._chosen_by_user, self._tried = row, True, None
        return True

    def try_diameter(self, diameter: float) -> Pipe | None:
        """Return what is shown as thick as a diameter (mm), as far away as it then looks as clicked; None where there is nothing yet."""
        import numpy as np

        from pipeworkbench.recon.vectors import as_vector

        base = self._untried
        if base is None or self.camera is None:
            return None
        centre, factor = self._centre, diameter / base.outer_diameter
        start, end = (as_vector(centre + factor * (np.array(point) - centre)) for point in (base.start, base.end))
        self._tried = replace(base, start=start, end=end, outer_diameter=diameter, dn=None, gaps=None)
        return self._tried

    @property
    def shown(self) -> Pipe | None:
        """The pipe to be drawn: as it is tried, as it was chosen, or as it is guessed so far."""
        return self._tried or self._untried

    @property
    def is_guess(self) -> bool:
        """Whether what is shown is not an answer yet."""
        return self._tried is not None or not self.answers

    def component(self) -> Pipe | None:
        """Return the chosen answer as a component with the clicks that made it; None where there is none."""
        from pipeworkbench.recon.reconstruct import as_component

        if not self.answers or self._request is None:
            return None
        pipe = as_component(self.answers[self._row], replace(self._request.pick, index=self.pick_index), self.station.name)
        diameter = {} if self.diameter is None else {"diameter": self.diameter}
        return replace(pipe, extra=pipe.extra | {CLICKED: {**(self._entry or {}), **diameter}})

    def component_of(self, candidate: PipeCandidate) -> Pipe:
        """Return an answer as a component, without the clicks."""
        from pipeworkbench.recon.reconstruct import as_component

        return as_component(candidate, None, self.station.name)

    def step_back(self) -> bool:
        """Take back the last step: a diameter that was tried, then the last click; whether there was one."""
        if self._tried is not None:
            self._tried = None
            return True
        if not self.touches:
            return False
        touches, camera = self.touches[:-1], self.camera
        self.restart()
        self.touches, self.camera = touches, camera if touches else None
        return True

    def restart(self) -> None:
        """Forget clicks and answers; the mode and the diameter that is asked for stay."""
        self.camera, self.touches, self.reason = None, [], ""
        self._forget_answers()
        self._entry = None

    def _forget_answers(self) -> None:
        self.answers, self._row, self._chosen_by_user = [], 0, False
        self._guess = self._tried = None
        self._is_measuring, self._request = False, None

    @property
    def _untried(self) -> Pipe | None:
        return self.component_of(self.answers[self._row]) if self.answers else self._guess

    @property
    def _centre(self) -> Array:
        """The projection centre (3,) of the camera that was clicked in."""
        return next(camera.projection_centre for camera in self.station.cameras if camera.name == self.camera)

    def _clicked_edges(self, edges: EdgeMap | None) -> list[list[list[float]]]:
        """Return two points on each of the edges, one where an edge cannot be followed."""
        import numpy as np

        from pipeworkbench.recon.followed_edges import edges_of_clicks

        points = np.array([touch.point for touch in self.touches])
        one, other = self.touches
        followed = edges_of_clicks(edges, points, (one.edge, other.edge)) if edges is not None else None
        if followed is None:
            return points[:, None].tolist()
        cameras = {camera.name: camera for camera in self.station.cameras}
        if not cameras[self.camera or ""].sees(followed.reshape(-1, 2)).all():
            return points[:, None].tolist()
        return followed.tolist()

    def _measure(self, entry: dict[str, Any]) -> None:
        """Ask for the answer to clicks, or say what is wrong with them."""
        from pipeworkbench.recon.picks import SCHEMA, picks_from

        self._forget_answers()
        self._entry = entry
        wanted = {} if self.diameter is None else {"diameter": self.diameter}
        picks = picks_from({"schema": SCHEMA, "picks": [entry | wanted]}, self.station)
        if picks.refused:
            self.reason = picks.refused[0].reason
            self._keep_first_click()
            return
        self._request = Request(picks.pipes[0])
        self._is_measuring = True
        self.reason = ""

    def _keep_first_click(self) -> None:
        """Go back to the first of two clicks of which the second cannot be right."""
        if len(self.touches) == 2:
            self.touches.pop()
            self._entry = None

    def _add(self, candidate: PipeCandidate) -> None:
        if not any(_is_same(candidate, other) for other in self.answers):
            self.answers.append(candidate)

    def _pipe(self, ends: Array, diameter: float) -> Pipe:
        from pipeworkbench.pipeline import Pipe
        from pipeworkbench.recon.vectors import as_vector

        size = pipe_size(diameter)
        return Pipe(id="guess", start=as_vector(ends[0]), end=as_vector(ends[1]), outer_diameter=diameter, dn=size.dn if size else None)


def _is_same(one: PipeCandidate, other: PipeCandidate | None) -> bool:
    from pipeworkbench.recon.candidates import same_cylinder

    return other is not None and same_cylinder(one, other)
