# SPDX-License-Identifier: LGPL-2.1-or-later
"""Stations of a document put together over the components they share, in one step of undo.

``merge_task`` and ``apply_merge`` touch the document; ``compute`` does not and may run in a thread.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from pipeworkbench.errors import InputError
from pipeworkbench.features.adjusting import frames_of
from pipeworkbench.features.component import set_component
from pipeworkbench.features.document import connections_in, pipeline_of, replace_components, stations_in
from pipeworkbench.features.station import station_of
from pipeworkbench.features.transactions import transaction
from pipeworkbench.pipeline import Matrix, Pipeline
from pipeworkbench.recon.station import Station

if TYPE_CHECKING:
    from pipeworkbench.recon.adjust import AdjustmentSettings, Solution
    from pipeworkbench.recon.register import CandidatePose, Registration

Progress = Callable[[str, int, int], None]


@dataclass(frozen=True, eq=False)
class MergeTask:
    """The pipelines to put together, the first in whose frame all will be, and the stations whose images show them."""

    pipelines: tuple[Pipeline, ...]
    stations: tuple[Station, ...]


@dataclass(frozen=True, eq=False)
class Merged:
    """What came out: the pipeline of all stations that could be merged, the registration that explains it, and the joint adjustment, if any."""

    task: MergeTask
    pipeline: Pipeline
    registration: Registration
    solution: Solution | None

    @property
    def merged_frames(self) -> tuple[str, ...]:
        """The frames that are one now, the reference first; one alone where nothing could be merged."""
        separate = {pipeline.frame for pipeline in self.registration.separate}
        return tuple(pipeline.frame for pipeline in self.task.pipelines if pipeline.frame not in separate)

    def motion_of(self, frame: str) -> Matrix:
        """Return the motion (4 x 4) from one of the merged frames to the common one."""
        import numpy as np

        own = next(pipeline for pipeline in self.task.pipelines if pipeline.frame == frame)
        # any station of the frame tells how the frame moved
        name, pose = next(iter(own.stations.items()))
        motion = np.array(self.pipeline.stations[name].frame_from_level) @ np.linalg.inv(np.array(pose.frame_from_level))
        return tuple(tuple(row) for row in motion.tolist())


def merge_task(document: Any, frames: Iterable[str] | None = None, *, with_images: bool = True) -> MergeTask:
    """Gather the components of frames (stations, or stations merged before) from a document.

    Parameters
    ----------
    document : FreeCAD document
    frames : iterable of str, optional
        Names, the reference first; by default all that have components.
    with_images : bool
        Whether an adjustment over all images is wanted.

    Raises
    ------
    InputError
        Where there are fewer than two, or one has no components.
    """
    objects = frames_of(document)
    names = list(objects if frames is None else frames)
    for name in names:
        if name not in objects:
            raise InputError(document.Label, name, "this station has no pipes or fittings", "measure some in its photographs first")
    if len(names) < 2:
        raise InputError(document.Label, "", "there are fewer than two stations with components", "choose two stations or more")
    pipelines = tuple(pipeline_of(document, objects[name]) for name in names)
    shown = {name for pipeline in pipelines for name in pipeline.stations}
    stations = tuple(station_of(obj) for obj in stations_in(document) if obj.StationName in shown) if with_images else ()
    return MergeTask(pipelines, stations)


def compute(
    task: MergeTask,
    adjustment: AdjustmentSettings | None = None,
    assignments: Iterable[tuple[str, str]] = (),
    progress: Progress = lambda text, done, total: None,  # noqa: ARG005
    chosen: Iterable[CandidatePose] = (),
) -> Merged:
    """Put stations together, and adjust all to all images where settings for that are given; the document is not touched.

    ``chosen`` are those of an earlier result's candidates that are right.
    """
    from pipeworkbench.recon.register import register
    from pipeworkbench.recon.together import adjusted_together
    from pipeworkbench.recon.views import views_by_station

    progress("looking for what the stations share", 0, 0)
    found = register(task.pipelines, assignments=assignments, chosen=chosen)
    pipeline, solution = found.pipeline, None
    if adjustment is not None and len(pipeline.stations) > 1 and found.pairs:
        views = views_by_station([station for station in task.stations if station.name in pipeline.stations], progress)
        if pipeline.stations.keys() - views.keys():
            missing = ", ".join(sorted(pipeline.stations.keys() - views.keys()))
            raise InputError("the adjustment", missing, "its photographs are not in the document", "import the station, or merge without adjustment")
        pipeline, solution = adjusted_together(pipeline, views, adjustment, progress)
    return Merged(task, pipeline, found, solution)


def apply_merge(document: Any, merged: Merged) -> list[Any]:
    """Bring the merged stations' components into the first one's frame; the caller makes the step of undo.

    Objects stay where they can: what two stations saw becomes the first one's object, the other is deleted.

    Raises
    ------
    InputError
        Where nothing could be merged.
    """
    others = merged.merged_frames[1:]
    if not others:
        raise InputError(document.Label, "", "no station could be merged", "; ".join(merged.registration.problems) or "add more to them")
    # by frame and id; deleted objects can no longer be asked for their names
    names = {frame: {obj.ComponentId: obj.Name for obj in own} for frame, own in frames_of(document).items()}
    kept = {_kept_object(names, sources, merged.merged_frames): new_id for new_id, sources in merged.registration.sources.items()}
    moved = {name for frame in others for name in names[frame].values()} & kept.keys()
    for name in {name for frame in merged.merged_frames for name in names[frame].values()} - kept.keys():
        document.removeObject(name)
    for name, new_id in kept.items():
        document.getObject(name).ComponentId = new_id
    connections = connections_in(document)
    for frame in connections.keys() & set(others):
        document.removeObject(connections[frame].Name)
    made = replace_components(document, merged.pipeline)
    # what is fixed in its own station moves with it all the same
    for obj, component in zip(made, merged.pipeline.components, strict=True):
        if obj.Fixed and obj.Name in moved:
            set_component(obj, component)
    return made


def _kept_object(names: Mapping[str, Mapping[str, str]], sources: Mapping[str, tuple[str, ...]], frames: Iterable[str]) -> str:
    """Return the name of the object that becomes a merged component: the first station's first."""
    return next(names[frame][sources[frame][0]] for frame in frames if sources.get(frame))


def merge_stations(
    document: Any,
    frames: Iterable[str] | None = None,
    adjustment: AdjustmentSettings | None = None,
    assignments: Iterable[tuple[str, str]] = (),
) -> Merged:
    """Merge stations of a document in one step of undo.

    Parameters
    ----------
    document : FreeCAD document
    frames : iterable of str, optional
        Names of stations, the reference first; by default all that have components.
    adjustment : AdjustmentSettings, optional
        Of the components and the stations' poses over all images afterwards; none without.
    assignments : iterable of (str, str)
        Components of two stations that are the same, by id.

    Raises
    ------
    InputError
        Where there is nothing to merge, or it could not be merged; the document is as it was.
    """
    merged = compute(merge_task(document, frames, with_images=adjustment is not None), adjustment, assignments)
    with transaction(document, "Merge Stations"):
        apply_merge(document, merged)
    return merged
