# SPDX-License-Identifier: LGPL-2.1-or-later
"""The common adjustment of a document's components: gathered from the document, computed without it, applied in one step of undo.

``task_of`` and ``apply_adjustment`` touch the document; ``compute`` does not and may run in a thread.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from pipeworkbench.errors import InputError
from pipeworkbench.features.document import components_in, frame_data, pipeline_of, replace_components, stations_in
from pipeworkbench.features.preferences import adjustment_settings
from pipeworkbench.features.station import station_of
from pipeworkbench.features.transactions import transaction
from pipeworkbench.pipeline import Component, Joint, Pipe, Pipeline
from pipeworkbench.recon.station import Station

if TYPE_CHECKING:
    from pipeworkbench.recon.adjust import AdjustmentSettings, Solution
    from pipeworkbench.recon.adjustment.changes import Change
    from pipeworkbench.recon.views import View

Progress = Callable[[str, int, int], None]


@dataclass(frozen=True, eq=False)
class AdjustmentTask:
    """The components of one frame and what is to be done with them.

    pipeline: all that hide each other in the images; chosen: ids of those that may move; stations: whose images show them;
    to_neighbours: whether joints to components that stay hold.
    """

    pipeline: Pipeline
    chosen: frozenset[str]
    stations: tuple[Station, ...]
    to_neighbours: bool = True


@dataclass(frozen=True, eq=False)
class Adjusted:
    """A task's result: the pipeline with the chosen components adjusted, the solution, and how each of the chosen ones moved."""

    task: AdjustmentTask
    pipeline: Pipeline
    solution: Solution
    changes: tuple[Change, ...]


def frames_of(document: Any, objects: Iterable[Any] | None = None) -> dict[str, list[Any]]:
    """Return component objects by the frame they are measured in: that of their station, or of the stations it is merged with."""
    chosen = components_in(document) if objects is None else list(objects)
    stations = {obj.StationName for obj in chosen}
    names = {station: frame_data(document, [station] if station else [])["frame"] for station in stations}
    frames: dict[str, list[Any]] = {}
    for obj in chosen:
        frames.setdefault(names[obj.StationName], []).append(obj)
    return frames


def tasks_of(document: Any, objects: Iterable[Any] | None = None, *, to_neighbours: bool = True) -> list[AdjustmentTask]:
    """Return what an adjustment of a document's components (or those among ``objects``) has to do, one task per frame.

    Raises
    ------
    InputError
        Where there is nothing to adjust, or no station whose images show it.
    """
    everything = frames_of(document)
    components = components_in(document)
    chosen = components if objects is None else [obj for obj in objects if obj in components]
    if not chosen:
        raise InputError(document.Label, "", "there are no pipes or fittings to adjust", "measure some, or select those to adjust")
    by_name = {obj.StationName: obj for obj in stations_in(document)}
    tasks = []
    for frame, own in frames_of(document, chosen).items():
        pipeline = pipeline_of(document, everything[frame])
        shown = [by_name[name] for name in pipeline.stations if name in by_name]
        if not shown:
            raise InputError(document.Label, frame, "there is no station whose photographs show these components", "import it")
        stations = tuple(station_of(obj) for obj in shown)
        tasks.append(AdjustmentTask(pipeline, frozenset(obj.ComponentId for obj in own), stations, to_neighbours))
    return tasks


def compute(
    task: AdjustmentTask,
    settings: AdjustmentSettings | None = None,
    progress: Progress = lambda text, done, total: None,  # noqa: ARG005
) -> Adjusted:
    """Adjust a task's components to the edges of all images; the document is not touched.

    Raises
    ------
    InputError
        Where an image cannot be read or the problem has no datum.
    """
    from pipeworkbench.recon.adjustment.changes import changes
    from pipeworkbench.recon.together import adjusted_together
    from pipeworkbench.recon.views import views_by_station

    given = task.pipeline
    views = views_by_station(task.stations, progress)
    # what stays is there all the same: it hides what is behind it
    components = tuple(component if component.id in task.chosen else replace(component, fixed=True) for component in given.components)
    seen = {name: pose for name, pose in given.stations.items() if name in views}
    problem = replace(given, components=components, joints=_joints(task), stations=seen)
    free_stations = len(seen) > 1 and task.chosen >= {component.id for component in given.components}
    adjust = adjusted_together if free_stations else _adjusted_in_place
    adjusted, solution = adjust(problem, views, settings or adjustment_settings(), progress)
    result = replace(
        given,
        components=tuple(new if new.id in task.chosen else old for new, old in zip(adjusted.components, given.components, strict=True)),
        stations=given.stations | adjusted.stations,
        sigma0=adjusted.sigma0,
        extra=adjusted.extra,
    )
    pairs = [(old, new) for old, new in zip(given.components, result.components, strict=True) if old.id in task.chosen]
    return Adjusted(task, result, solution, changes([old for old, _ in pairs], [new for _, new in pairs]))


def apply_adjustment(document: Any, results: Sequence[Adjusted]) -> None:
    """Give the document's components what was adjusted; the caller makes the step of undo."""
    for result in results:
        replace_components(document, result.pipeline, result.task.chosen)


def adjust_document(
    document: Any,
    objects: Iterable[Any] | None = None,
    settings: AdjustmentSettings | None = None,
    progress: Progress = lambda text, done, total: None,  # noqa: ARG005
) -> list[Adjusted]:
    """Adjust a document's components (or those among ``objects``) to the edges of all images, as one step of undo.

    Parameters
    ----------
    document : FreeCAD document
    objects : iterable of document objects, optional
        Others stay where they are; so do components that are fixed.
    settings : AdjustmentSettings, optional
        The user's where they are not given.
    progress : callable
        Called with what is being done, how many steps are done and how many there are.

    Returns
    -------
    list of Adjusted
        One for each frame: stations that are not merged are adjusted by themselves.

    Raises
    ------
    InputError
        Where there is nothing to adjust or the photographs cannot be read; the document is as it was.
    """
    results = [compute(task, settings, progress) for task in tasks_of(document, objects)]
    with transaction(document, "Adjust"):
        apply_adjustment(document, results)
    return results


def _joints(task: AdjustmentTask) -> tuple[Joint, ...]:
    """Return the joints that hold: between two components that stay there is nothing to hold."""
    return tuple(
        joint
        for joint in task.pipeline.joints
        if (joint.a in task.chosen or joint.b in task.chosen) and (task.to_neighbours or {joint.a, joint.b} <= task.chosen)
    )


def _adjusted_in_place(
    problem: Pipeline, views: Mapping[str, Sequence[View]], settings: AdjustmentSettings, progress: Progress
) -> tuple[Pipeline, Solution]:
    """Adjust components to the images of stations that stay where they are."""
    import numpy as np

    from pipeworkbench.recon.adjust import Problem, StationViews, adjust
    from pipeworkbench.recon.adjustment.changes import with_solution

    stations = tuple(StationViews(name, views[name], np.array(pose.frame_from_level)) for name, pose in problem.stations.items())
    # what was never adjusted has a place of its own from its recognition
    placed = frozenset(component.id for component in problem.components if problem.sigma0 is None and _is_measured_pipe(component))
    solution = adjust(Problem(problem.components, stations, problem.joints, placed=placed), settings, progress)
    return with_solution(problem, solution), solution


def _is_measured_pipe(component: Component) -> bool:
    return isinstance(component, Pipe) and component.sigma_position is not None and component.sigma_direction_deg is not None


def state_of(document: Any) -> tuple[Any, ...]:
    """Return what a preview depends on: it is outdated where this has changed."""
    return tuple(
        (obj.Name, obj.ComponentId, obj.Fixed, obj.OutsideDiameter.Value, tuple(obj.Placement.toMatrix().A), obj.MeasuredAs)
        for obj in components_in(document)
    )
