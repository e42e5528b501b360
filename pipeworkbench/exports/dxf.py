# SPDX-License-Identifier: LGPL-2.1-or-later
"""Flat parts as DXF for cutting machines: single parts, or sheets with all that is cut from them.

Outlines and holes are closed polylines of straight lines and true arcs on the layer CUT, round holes are circles. Every
entity of a part carries the part's id and number as extended data, so that a program can tell parts apart.
"""

from __future__ import annotations

import math
import re
import unicodedata
from collections.abc import Iterator, Sequence
from pathlib import Path as FilePath
from typing import Any

import numpy as np

from pipeworkbench.errors import InputError, MissingPackageError, one_line
from pipeworkbench.exports.sheets import NestedSheet, Placed
from pipeworkbench.files import written_whole
from pipeworkbench.insulation.flat import Path, Pattern, Text
from pipeworkbench.recon.camera import Array

VERSION = "R2010"
APPLICATION = "PIPEWORKBENCH"  # whose extended data names the part an entity belongs to
DASHED, CENTRE_LINE = "DASHED", "CENTER"
LINETYPES = ((DASHED, [9.0, 6.0, -3.0]), (CENTRE_LINE, [20.0, 12.0, -3.0, 2.0, -3.0]))  # mm: period, then dashes and gaps
# layer: colour (AutoCAD's index), line type, plotted; a sheet's own outline is for the eye
LAYERS = {
    "CUT": (1, "CONTINUOUS", True),
    "MARK": (5, "CONTINUOUS", True),
    "FOLD": (3, DASHED, True),
    "CENTRE": (4, CENTRE_LINE, True),
    "TEXT": (6, "CONTINUOUS", True),
    "SHEET": (8, "CONTINUOUS", False),
}
SMALLEST_STEP = 1e-6  # mm; points nearer to each other are one
SAME_CIRCLE = 1e-6  # mm by which centres and radii of one circle's arcs may differ
GAP_BETWEEN_SHEETS = 200.0  # mm
TITLE_HEIGHT = 25.0  # mm, of the text below a sheet
LONGEST_XDATA = 255  # bytes of a string in extended data
LONGEST_NAME = 80  # bytes of a file's name without ending
# what a reader of DXF would take for a control code; the exact id stands in the list of parts
CONTROL_CODES = (("^", "^ "), ("%%", "% %"), ("\\U+", "\\ U+"), ("\\M+", "\\ M+"))
RESERVED_NAMES = re.compile(r"(?i)(con|prn|aux|nul|com\d|lpt\d)(\.|$)")  # of Windows


def write_dxf(what: Sequence[Pattern] | Sequence[NestedSheet], path: FilePath) -> None:
    """Write nested sheets, or patterns as they are (each once, beside each other), into one DXF file.

    Raises
    ------
    InputError
        Where there is nothing to write, or a part's coordinates are not finite.
    MissingPackageError
        Where ezdxf is not installed.
    """
    sheets = [one for one in what if isinstance(one, NestedSheet)]
    patterns = [one for one in what if isinstance(one, Pattern)]
    if sheets:
        write_sheets(sheets, path)
    else:
        _write_parts_into(_in_a_row(_something(patterns, path)), path)


def write_parts(patterns: Sequence[Pattern], folder: FilePath) -> tuple[FilePath, ...]:
    """Write each part into a file of its own in a folder, which is made where it is missing.

    Returns
    -------
    tuple of Path
        The files in the order of the patterns; their names are made of the parts' ids.

    Raises
    ------
    InputError
        Where there is no part, its coordinates are not finite or the folder cannot be made.
    MissingPackageError
        Where ezdxf is not installed.
    """
    _something(patterns, folder)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(folder, "", f"the folder cannot be made ({error.strerror})", "name a folder that can be written") from None
    files = part_files(patterns, folder)
    for pattern, file in zip(patterns, files, strict=True):
        _write_parts_into([Placed(pattern, 1, 0.0, (0.0, 0.0))], file)
    return files


def part_files(patterns: Sequence[Pattern], folder: FilePath) -> tuple[FilePath, ...]:
    """Return the files of ``write_parts`` in the order of the patterns."""
    return tuple(folder / f"{name}.dxf" for name in file_names([pattern.id for pattern in patterns]))


def write_sheets(sheets: Sequence[NestedSheet], path: FilePath) -> None:
    """Write all sheets into one file, side by side from the first at the origin.

    Raises
    ------
    InputError
        Where there is no sheet, or a part's coordinates are not finite.
    MissingPackageError
        Where ezdxf is not installed.
    """
    document = _new_document()
    place = 0.0
    for sheet in _something(sheets, path):
        _add_sheet(document, sheet, (place, 0.0))
        place += sheet.size.width + GAP_BETWEEN_SHEETS
    _save(document, (0.0, -3 * TITLE_HEIGHT), (place - GAP_BETWEEN_SHEETS, max(sheet.size.height for sheet in sheets)), path)


def write_sheet_files(sheets: Sequence[NestedSheet], folder: FilePath) -> tuple[FilePath, ...]:
    """Write each sheet into a file of its own in a folder, ``sheet_001.dxf`` and on; return the files.

    Errors are those of ``write_parts``.
    """
    _something(sheets, folder)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(folder, "", f"the folder cannot be made ({error.strerror})", "name a folder that can be written") from None
    files = tuple(folder / f"sheet_{sheet.number:03d}.dxf" for sheet in sheets)
    for sheet, file in zip(sheets, files, strict=True):
        write_sheets([sheet], file)
    return files


def file_names(ids: Sequence[str]) -> list[str]:
    """Return a name for a file of each id, without ending: different ones that every system takes, alike to the ids."""
    names: list[str] = []
    taken: set[str] = set()
    for one in ids:
        name = _file_name(one)
        number, candidate = 1, name
        # many systems do not tell capitals apart, and some compose letters
        while candidate.casefold() in taken:
            number += 1
            candidate = f"{name}_{number}"
        taken.add(candidate.casefold())
        names.append(candidate)
    return names


def _file_name(text: str) -> str:
    name = re.sub(r"[^\w.-]+", "_", unicodedata.normalize("NFC", text)).strip("._-")
    name = name.encode()[:LONGEST_NAME].decode(errors="ignore").rstrip("._-")
    return f"part_{name}" if not name or RESERVED_NAMES.match(name) else name


def _something(what: Sequence[Any], target: object) -> Sequence[Any]:
    if not what:
        raise InputError(target, "", "there is no part to be cut", "give the insulation a jacket of sheet metal")
    return what


def _in_a_row(patterns: Sequence[Pattern]) -> list[Placed]:
    """Return parts beside each other on the x axis, with room between them."""
    placed, place = [], 0.0
    for pattern in patterns:
        left, bottom, right, _ = pattern.outline.bounds
        placed.append(Placed(pattern, 1, 0.0, (place - left, -bottom)))
        place += right - left + GAP_BETWEEN_SHEETS
    return placed


def _write_parts_into(parts: Sequence[Placed], path: FilePath) -> None:
    document = _new_document()
    for part in parts:
        _add_part(document, part, (0.0, 0.0))
    left, bottom, right, top = zip(*(part.bounds for part in parts), strict=True)
    _save(document, (min(left), min(bottom)), (max(right), max(top)), path)


def _new_document() -> Any:
    try:
        import ezdxf
    except ImportError:
        raise MissingPackageError("ezdxf", "Writing DXF", "pip install 'ezdxf>=1.3,<2'") from None
    document = ezdxf.new(VERSION)
    document.units = ezdxf.units.MM
    document.header["$MEASUREMENT"] = 1  # metric
    document.appids.add(APPLICATION)
    for name, pattern in LINETYPES:
        document.linetypes.add(name, pattern)
    for name, (colour, linetype, plotted) in LAYERS.items():
        document.layers.add(name, color=colour, linetype=linetype, plot=plotted)
    return document


def _save(document: Any, lower: tuple[float, float], upper: tuple[float, float], path: FilePath) -> None:
    """Write the file; a program that opens it shows all between two corners (mm)."""
    document.modelspace().reset_extents((*lower, 0), (*upper, 0))
    document.header["$EXTMIN"], document.header["$EXTMAX"] = (*lower, 0), (*upper, 0)
    width, height = upper[0] - lower[0], upper[1] - lower[1]
    document.set_modelspace_vport(1.1 * max(height, width / 2), ((lower[0] + upper[0]) / 2, (lower[1] + upper[1]) / 2))
    with written_whole(path) as temporary:
        document.saveas(temporary)


def _add_sheet(document: Any, sheet: NestedSheet, shift: tuple[float, float]) -> None:
    space = document.modelspace()
    (x, y), (width, height) = shift, (sheet.size.width, sheet.size.height)
    corners = [(x, y), (x + width, y), (x + width, y + height), (x, y + height)]
    space.add_lwpolyline(corners, close=True, dxfattribs={"layer": "SHEET"})
    title = f"{sheet.number}: {sheet.sheet.material} {sheet.sheet.thickness:g} mm, {width:g} x {height:g} mm, {100 * sheet.used:.0f} %"
    space.add_text(_dxf_text(title), height=TITLE_HEIGHT, dxfattribs={"layer": "SHEET", "insert": (x, y - 2 * TITLE_HEIGHT)})
    for part in sheet.parts:
        _add_part(document, part, shift)


def _add_part(document: Any, part: Placed, shift: tuple[float, float]) -> None:
    pattern = part.pattern
    made = [_add_path(document, part.path(path), "CUT", shift, pattern.id) for path in (pattern.outline, *pattern.holes)]
    made += [_add_path(document, part.path(path), layer, shift, pattern.id) for layer, path in _each_once(pattern)]
    made += [_add_text(document, part.text(text), shift) for text in pattern.texts]
    for entity in made:
        entity.set_xdata(APPLICATION, [(1000, _xdata_text(pattern.id)), (1070, part.number)])


def _each_once(pattern: Pattern) -> Iterator[tuple[str, Path]]:
    """Yield marks without those that lie on another: a line that is scribed twice is burnt through."""
    seen: set[tuple[Any, ...]] = set()
    for layer, path in pattern.marks:
        if _key(path) not in seen:
            seen |= {_key(path), _key(path.reversed())}
            yield layer, path


def _key(path: Path) -> tuple[Any, ...]:
    # adding zero makes one number of both zeros
    return (np.round(path.points, 4) + 0.0).tobytes(), (np.round(path.bulges, 6) + 0.0).tobytes()


def _add_path(document: Any, path: Path, layer: str, shift: tuple[float, float], part_id: str) -> Any:
    """Add a path as a circle, a line or a polyline with bulges."""
    if not (np.isfinite(path.points).all() and np.isfinite(path.bulges).all()):
        raise InputError(part_id, "", f"a line on the layer {layer} is not finite", "correct the dimensions of the component")
    points, bulges = _without_repeats(path)
    if len(points) < 2:
        raise InputError(part_id, "", f"a line on the layer {layer} has no extent", "correct the dimensions of the component")
    points = points + np.asarray(shift)
    space, attributes = document.modelspace(), {"layer": layer}
    circle = _circle(points, bulges) if path.closed else None
    if circle is not None:
        centre, radius = circle
        return space.add_circle((float(centre[0]), float(centre[1])), radius, dxfattribs=attributes)
    vertices = [(float(x), float(y), float(bulge)) for (x, y), bulge in zip(points, bulges, strict=True)]
    if not path.closed and len(vertices) == 2 and not vertices[0][2]:
        return space.add_line(vertices[0][:2], vertices[1][:2], dxfattribs=attributes)
    return space.add_lwpolyline(vertices, format="xyb", close=path.closed, dxfattribs=attributes)


def _without_repeats(path: Path) -> tuple[Array, Array]:
    """Return points and bulges without points that repeat the one before: machines stop at lines without length."""
    following = np.roll(path.points, -1, axis=0)
    step = np.linalg.norm(following - path.points, axis=1)
    keep = step > SMALLEST_STEP
    if not path.closed:
        keep[-1] = True
    return path.points[keep], path.bulges[keep]


def _circle(points: Array, bulges: Array) -> tuple[Array, float] | None:
    """Return centre and radius where all arcs (at least two) lie on one circle and go around it once."""
    if len(points) < 2 or (bulges == 0).any() or not math.isclose(abs(float(np.arctan(bulges).sum())) * 4, 2 * math.pi, rel_tol=1e-9):
        return None
    chords = np.roll(points, -1, axis=0) - points
    left = np.column_stack([-chords[:, 1], chords[:, 0]])
    # the centre lies (1 - b²) / 4b chords to the left of the chord's middle
    centres = points + chords / 2 + left * ((1 - bulges**2) / (4 * bulges))[:, None]
    radii = np.linalg.norm(points - centres, axis=1)
    if np.ptp(centres, axis=0).max() > SAME_CIRCLE or np.ptp(radii) > SAME_CIRCLE:
        return None
    return centres.mean(axis=0), float(radii.mean())


def _add_text(document: Any, text: Text, shift: tuple[float, float]) -> Any:
    place = (text.position[0] + shift[0], text.position[1] + shift[1])
    attributes = {"layer": "TEXT", "insert": place, "rotation": text.angle_deg}
    return document.modelspace().add_text(_dxf_text(text.text), height=text.height, dxfattribs=attributes)


def _dxf_text(text: str) -> str:
    text = one_line(text)
    for code, plain in CONTROL_CODES:
        text = text.replace(code, plain)
    return text


def _xdata_text(text: str) -> str:
    return _dxf_text(text).encode()[:LONGEST_XDATA].decode(errors="ignore")
