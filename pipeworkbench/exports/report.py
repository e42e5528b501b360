# SPDX-License-Identifier: LGPL-2.1-or-later
"""The report: one HTML file that says what was measured and how well, with its photographs and charts inside."""

from __future__ import annotations

import base64
import datetime as dt
import math
from collections import defaultdict
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from pipeworkbench import __version__
from pipeworkbench.errors import InputError, MissingPackageError
from pipeworkbench.exports.charts import accuracy_charts
from pipeworkbench.exports.kinds import equivalents_text, size_of
from pipeworkbench.exports.pictures import annotated
from pipeworkbench.exports.texts import Texts, texts_of
from pipeworkbench.files import package_folder, written_whole
from pipeworkbench.pipeline import BLIND_FLANGE, AnyComponent, Elbow, Flange, Joint, Pipe, Pipeline, Reducer, StationPose, Tee
from pipeworkbench.recon.adjustment.changes import SUMMARY_KEY
from pipeworkbench.recon.station import Station

if TYPE_CHECKING:
    import jinja2

TEMPLATE, TEXTS = "report.html.j2", "report.texts.json"
PHOTO_WIDTH = 1000  # px
JPEG_QUALITY = 82
NOTHING = "–"

Row = dict[str, Any]


def write_report(
    pipeline: Pipeline,
    path: Path,
    stations: Sequence[Station] = (),
    *,
    language: str = "en",
    title: str | None = None,
    photographs: bool = True,
) -> None:
    """Write the report as one self-contained HTML file.

    Parameters
    ----------
    pipeline : Pipeline
    path : Path
    stations : sequence of Station
        Those whose cameras are named and whose photographs are shown with the components' contours.
    language : str
        One of ``texts.LANGUAGES``.
    title : str, optional
        The project's name; by default the pipeline's frame.
    photographs : bool
        False leaves the photographs out, which make most of the file's size.

    Raises
    ------
    InputError
        Where the language is not known or a photograph cannot be read.
    MissingPackageError
        Where jinja2 or matplotlib is not installed.
    """
    page = report_page(pipeline, stations, language=language, title=title, photographs=photographs)
    with written_whole(path) as temporary:
        temporary.write_text(page, encoding="utf-8")


def report_page(
    pipeline: Pipeline, stations: Sequence[Station] = (), *, language: str = "en", title: str | None = None, photographs: bool = True
) -> str:
    """Return the report's HTML; parameters and errors are those of ``write_report``."""
    texts = _texts(language)
    shown = [station for station in stations if station.name in pipeline.stations]
    georeference = pipeline.extra.get("georeference")
    note = texts["plant_note" if isinstance(georeference, Mapping) else "frame_note"]
    return _template().render(
        language=language,
        t=texts,
        version=__version__,
        date=dt.datetime.now(tz=dt.UTC).astimezone().strftime("%Y-%m-%d %H:%M"),
        title=title or texts["title"].format(frame=pipeline.frame),
        frame_note=note.format(frame=pipeline.frame),
        figures=_figures(pipeline, texts),
        stations=[_station_row(name, pose, shown) for name, pose in pipeline.stations.items()],
        material=_material(pipeline, texts),
        components=[_component_row(component, texts) for component in pipeline.components],
        charts=accuracy_charts(pipeline, texts),
        adjustment=_adjustment(pipeline, texts),
        joints=_joint_rows(pipeline, texts),
        photographs=[_photographs(station, pipeline) for station in shown] if photographs else [],
    )


def _template() -> jinja2.Template:
    try:
        import jinja2
    except ImportError:
        raise MissingPackageError("jinja2", "Writing a report", "pip install 'jinja2>=3.1,<4'") from None
    loader = jinja2.FileSystemLoader(package_folder("resources") / "templates")
    # names come from files and users: everything is escaped but what this program draws
    environment = jinja2.Environment(loader=loader, autoescape=True, undefined=jinja2.StrictUndefined, trim_blocks=True, lstrip_blocks=True)
    return environment.get_template(TEMPLATE)


def _texts(language: str) -> Texts:
    return texts_of(TEXTS, language, "the report")


def _figures(pipeline: Pipeline, texts: Texts) -> list[Row]:
    """Return the few numbers that everybody looks for first."""
    sigmas = [math.hypot(*component.sigma_position) for component in pipeline.components if component.sigma_position is not None]
    figures = [
        (str(len(pipeline.components)), "components"),
        (f"{sum(pipe.length for pipe in pipeline.pipes) / 1000:.2f}", "length"),
        (str(len(pipeline.stations)), "stations"),
        (_number(float(np.median(sigmas)) if sigmas else None, 2), "sigma"),
        (_number(pipeline.sigma0, 2), "sigma0"),
    ]
    return [{"value": value, "name": texts[f"figure_{name}"]} for value, name in figures if value != NOTHING]


def _station_row(name: str, pose: StationPose, shown: Sequence[Station]) -> Row:
    matrix = np.array(pose.frame_from_level)
    sigma = pose.extra.get("sigma_position")
    cameras = next((", ".join(camera.name for camera in station.cameras) for station in shown if station.name == name), NOTHING)
    return {
        "name": name,
        "origin": [f"{value:.1f}" for value in matrix[:3, 3]],
        "heading": f"{math.degrees(math.atan2(matrix[1, 0], matrix[0, 0])):.3f}",
        "sigma": _number(math.hypot(*sigma) if isinstance(sigma, list | tuple) else None, 2),
        "cameras": cameras,
    }


def _material(pipeline: Pipeline, texts: Texts) -> list[Row]:
    """Return how many there are of each item, and how long its pipes are together."""
    items: dict[tuple[str, str], list[AnyComponent]] = defaultdict(list)
    for component in pipeline.components:
        items[_kind(component, texts), _dimensions(component, texts)].append(component)
    return [
        {
            "kind": kind,
            "dimensions": dimensions,
            "count": len(components),
            "length": f"{sum(one.length for one in components) / 1000:.2f}" if isinstance(components[0], Pipe) else NOTHING,
        }
        for (kind, dimensions), components in sorted(items.items())
    ]


def _component_row(component: AnyComponent, texts: Texts) -> Row:
    return {
        "id": component.id,
        "kind": _kind(component, texts),
        "dimensions": _dimensions(component, texts),
        "diameter": f"{component.outer_diameter:.1f}",
        "length": f"{component.length:.0f}",
        "standard": component.standard or NOTHING,
        "sources": NOTHING if component.verified is None else texts["grades"][str(component.verified)],
        "unverified": component.verified == 0,
        "sigma": _number(None if component.sigma_position is None else math.hypot(*component.sigma_position), 2),
        "sigma_direction": _number(component.sigma_direction_deg, 3),
        "quality": _number(component.quality, 2),
        "loa": component.loa or NOTHING,
        "remarks": ", ".join(_remarks(component, texts)),
    }


def _kind(component: AnyComponent, texts: Texts) -> str:
    blind = isinstance(component, Flange) and component.flange_type == BLIND_FLANGE
    name = "blind" if blind else component.tee_type if isinstance(component, Tee) else component.kind
    return str(texts["kinds"][name])


def _dimensions(component: AnyComponent, texts: Texts) -> str:
    """Return what tells a component from others of its kind."""
    size = size_of(component)
    match component:
        case Elbow():
            bend = f"{component.bend_type}, " if component.bend_type else ""
            return f"{size}, {component.angle_deg:.3g}°, {bend}R {component.bend_radius:.4g} mm"
        case Flange():
            return f"{size}, {texts['type']} {component.flange_type}, PN {component.pn:g}"
        case Tee():
            return f"{size}, {texts['branch']} {component.branch_diameter:.1f} mm"
        case Reducer():
            return f"{size} > {component.end_diameter:.1f} mm, {texts[component.reducer_type]}"
        case _:
            wall = f" × {component.wall_thickness:g} mm" if component.wall_thickness else ""
            return f"{size} ({component.outer_diameter:.1f}{wall})" if component.dn else f"{component.outer_diameter:.1f} mm"


def _remarks(component: AnyComponent, texts: Texts) -> list[str]:
    """Return what a reader must know before he trusts a component's figures."""
    said = []
    if isinstance(component, Pipe):
        if component.approximate:
            said.append(texts["approximate"])
        if component.nearest_standard:
            said.append(texts["near_standard"].format(standard=component.nearest_standard))
        if component.gaps:
            said.append(texts["bridged"].format(gaps=", ".join(f"{start:.0f}–{end:.0f}" for start, end in component.gaps)))
    if isinstance(component, Flange) and component.equivalents:
        said.append(texts["equivalents"].format(others=equivalents_text(component)))
    if component.fixed:
        said.append(texts["fixed"])
    return said


def _adjustment(pipeline: Pipeline, texts: Texts) -> Row | None:
    """Return what is known of the adjustment; files of other programs may say less than ours, or something else."""
    summary = pipeline.extra.get(SUMMARY_KEY)
    if not isinstance(summary, Mapping):
        note = texts["sigma0_note"].format(sigma0=_number(pipeline.sigma0, 2))
        return None if pipeline.sigma0 is None else {"summary": note, "images": [], "remarks": []}
    known: Mapping[str, Any] = defaultdict(lambda: None, summary)
    text = texts["adjustment_note"].format(
        sigma0=_number(known["sigma0"], 2),
        sigma_image=_number(known["sigma_image_px"], 2),
        observations=_number(known["observations"], 0),
        unknowns=_number(known["unknowns"], 0),
        redundancy=_number(known["redundancy"], 0),
        iterations=_number(known["iterations"], 0),
        ended=texts["converged" if known["converged"] else "not_converged"],
    )
    images = [
        {
            "name": f"{image.get('station')} / {image.get('image')}",
            "rms": _number(image.get("rms_px"), 2),
            "found": _number(100 * image.get("found", 0) / max(image.get("samples", 0), 1), 0),
        }
        for image in known["images"] or ()
    ]
    remarks = [
        texts["gross_left_out" if one.get("left_out") else "gross"].format(
            what=one.get("what"), size=_number(one.get("size"), 2), w=_number(one.get("w"), 1)
        )
        for one in known["gross"] or ()
    ]
    remarks += [texts["weak"].format(component=one.get("component"), sigma=_number(one.get("sigma_mm"), 1)) for one in known["weak"] or ()]
    remarks += [texts["undetermined"].format(component=name) for name in known["undetermined"] or ()]
    return {"summary": text, "images": images, "remarks": remarks}


def _joint_rows(pipeline: Pipeline, texts: Texts) -> list[Row]:
    by_id = {component.id: component for component in pipeline.components}
    return [_joint_row(joint, by_id, texts) for joint in pipeline.joints]


def _joint_row(joint: Joint, by_id: Mapping[str, AnyComponent], texts: Texts) -> Row:
    one, other = by_id[joint.a], by_id[joint.b]
    here, there = one.ports[joint.a_port], other.ports[joint.b_port]
    cosine = -sum(a * b for a, b in zip(here.direction, there.direction, strict=True))
    return {
        "a": one.id,
        "a_end": _end(one, joint.a_port, texts),
        "b": other.id,
        "b_end": _end(other, joint.b_port, texts),
        "gap": f"{math.dist(here.point, there.point):.2f}",
        "kink": f"{math.degrees(math.acos(max(-1.0, min(1.0, cosine)))):.2f}",
    }


def _end(component: AnyComponent, port: int, texts: Texts) -> str:
    return str(texts["flange_ends" if isinstance(component, Flange) else "ends"][port])


def _photographs(station: Station, pipeline: Pipeline) -> Row:
    level_from_frame = np.linalg.inv(np.array(pipeline.stations[station.name].frame_from_level))
    photos = [
        {"name": f"{station.name} / {camera.name}", "data": _jpeg(annotated(station, index, pipeline, level_from_frame))}
        for index, camera in enumerate(station.cameras)
    ]
    return {"name": station.name, "photos": photos}


def _jpeg(picture: Any) -> str:
    """Return a picture (height, width, 3) BGR as the address of an embedded JPEG."""
    import cv2

    scale = min(1.0, PHOTO_WIDTH / picture.shape[1])
    small = cv2.resize(picture, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
    good, data = cv2.imencode(".jpg", small, [cv2.IMWRITE_JPEG_QUALITY, JPEG_QUALITY])
    if not good:
        raise InputError("the report", "", "a photograph could not be encoded", "write the report without photographs")
    return "data:image/jpeg;base64," + base64.b64encode(data.tobytes()).decode("ascii")


def _number(value: Any, digits: int) -> str:
    known = isinstance(value, int | float) and math.isfinite(value)
    return f"{value:.{digits}f}" if known else NOTHING
