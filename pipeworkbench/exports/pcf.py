# SPDX-License-Identifier: LGPL-2.1-or-later
"""PCF, the piping component file that software for isometrics reads: components with their ends, centres, bores and items.

The format's own guide is its owner's and not public. This writer follows what is: the symbol keys and component names that AVEVA
(E3D, "Symbol Keys") and PTC (Creo Piping, "ISOGEN Symbol Map File") publish in their manuals, and the layout that open readers and
the files of other programs agree in: a header of units, a PIPELINE-REFERENCE for each pipeline, components whose lines are indented by
four blanks, points as x, y, z and nominal bore, an elbow's ANGLE in hundredths of a degree and its CENTRE-POINT where both tangents meet,
and MATERIALS with a DESCRIPTION for every ITEM-CODE. No program that reads PCF was at hand to confirm it.

A pipeline is what hangs together by joints. Joined ends lie in one place, the middle where measuring left a gap; faces of flanges
that stand apart have a GASKET between them. A bore is the nominal diameter, the outside diameter where that is not known. A set-on
branch is a TEE-SET-ON on a pipe that runs through. Insulation is said per component: INSULATION ON, INSULATION-SPEC (layers and jacket)
and COMPONENT-ATTRIBUTE1 (thickness of all layers, mm). Supports are not measured and not written.
"""

from __future__ import annotations

import dataclasses
import unicodedata
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from pipeworkbench.catalogue import pipe_size
from pipeworkbench.errors import InputError
from pipeworkbench.exports.bolting import BoltedJoint, bolted_joints
from pipeworkbench.exports.ifc_network import End, network_of
from pipeworkbench.exports.insulated import build_text, builds_of
from pipeworkbench.exports.kinds import size_of
from pipeworkbench.exports.take_off import Item, bolts_of, gasket_of, item_of
from pipeworkbench.files import written_whole
from pipeworkbench.insulation.runs import runs_of
from pipeworkbench.pipeline import AnyComponent, Cap, Elbow, Flange, Pipe, Pipeline, Reducer, Tee, Vector, free_id

if TYPE_CHECKING:
    from pipeworkbench.insulation.planning import Plan

HEADER = (
    "ISOGEN-FILES ISOGEN.FLS",
    "UNITS-BORE MM",
    "UNITS-CO-ORDS MM",
    "UNITS-BOLT-LENGTH MM",
    "UNITS-BOLT-DIA MM",
    "UNITS-WEIGHT KGS",
)
INDENT = "    "
LINE_END = "\r\n"  # as the programs that read PCF write it themselves
COORDINATE_DIGITS = 4
HUNDREDTHS = 100  # of a degree, in which angles are written
SYSTEM = "system"  # what a component's extra calls the user's name of its pipeline
# of EN 1092-1: blind, plate and hubbed slip-on, loose, threaded, weld neck
FLANGE_KEYS = {"05": "FLBL", "01": "FLSO", "12": "FLSO", "02": "FLLB", "04": "FLLB", "13": "FLSC", "11": "FLWN"}
SIDES = ("EAST", "WEST", "NORTH", "SOUTH", "UP", "DOWN")  # of x, y and z, there and back

Lines = Iterator[str]


def write_pcf(pipeline: Pipeline, path: Path, plan: Plan | None = None) -> None:
    """Write a PCF file, whole or not at all; the same pipeline gives the same file.

    Raises
    ------
    InputError
        Where there is nothing to write, a joint does not fit or what a component says of its insulation.
    """
    if not pipeline.components:
        raise InputError(path, "", "the pipeline has no components", "reconstruct some first")
    text = LINE_END.join((*HEADER, *_Writer(pipeline, plan).lines(), ""))
    with written_whole(path) as temporary:
        temporary.write_bytes(text.encode("ascii"))


class _Writer:
    """Gives a pipeline's lines and gathers its items on the way."""

    def __init__(self, pipeline: Pipeline, plan: Plan | None) -> None:
        self.pipeline = pipeline
        self.bolted = bolted_joints(pipeline)
        self.places = _places(pipeline, self.bolted)
        self.builds = builds_of(pipeline, plan)
        self.names = _plain_names(component.id for component in pipeline.components)
        self.codes: dict[Item, str] = {}

    def lines(self) -> Lines:
        """Yield everything behind the header."""
        runs = runs_of(self.pipeline)
        members: dict[str, list[AnyComponent]] = {}
        for component in self.pipeline.components:
            members.setdefault(runs[component.id], []).append(component)
        used: set[str] = set()
        for run, components in members.items():
            title = free_id(_word(_title(run, components)), used)
            used.add(title)
            yield f"PIPELINE-REFERENCE {title}"
            yield f"{INDENT}PROJECT-IDENTIFIER {_word(self.pipeline.frame)}"
            for component in components:
                yield from self._component(component)
            for joint in self.bolted:
                if runs[joint.a.id] == run:
                    yield from self._bolted(joint)
        yield "MATERIALS"
        for item, code in self.codes.items():
            yield f"ITEM-CODE {code}"
            yield f"{INDENT}DESCRIPTION {_description(item)}"

    def _component(self, component: AnyComponent) -> Lines:
        """Yield a component's lines."""
        about = self._about(component)
        match component:
            case Pipe():
                yield from _record("PIPE", self._ends(component), about)
            case Elbow():
                centre = _point("CENTRE-POINT", component.intersection, _bore(component, component.outer_diameter))
                angle = f"ANGLE {round(component.angle_deg * HUNDREDTHS)}"
                yield from _record("ELBOW", [*self._ends(component), centre, "SKEY ELBW", angle], about)
            case Flange():
                yield from self._flange(component, about)
            case Tee():
                yield from self._tee(component, about)
            case Reducer() if component.reducer_type == "concentric":
                yield from _record("REDUCER-CONCENTRIC", [*self._ends(component), "SKEY RCBW"], about)
            case Reducer():
                yield from _record("REDUCER-ECCENTRIC", [*self._ends(component), "SKEY REBW", f"FLAT-DIRECTION {_flat_side(component)}"], about)
            case Cap():
                far = tuple(a + component.length * b for a, b in zip(component.start, component.axis, strict=True))
                bore = _bore(component, component.outer_diameter)
                yield from _record("CAP", [*self._ends(component), _point("END-POINT", far, bore), "SKEY KABW"], about)

    def _tee(self, tee: Tee, about: Sequence[str]) -> Lines:
        """Yield a tee's lines; a set-on branch and the pipe that runs through under it are two components."""
        run, middle = self._ends(tee), _point("CENTRE-POINT", tee.intersection, _bore(tee, tee.outer_diameter))
        branch = _point("BRANCH1-POINT", self.places[tee.id, 2], _bore(tee, tee.branch_diameter))
        if tee.tee_type == "tee":
            yield from _record("TEE", [*run, middle, branch, "SKEY TEBW"], about)
            return
        pipe = dataclasses.replace(item_of(tee), kind=Pipe.kind, description=f"Pipe {size_of(tee)}")
        name = free_id(f"{self.names[tee.id]}-RUN", self.names.values())
        yield from _record("PIPE", run, [f"ITEM-CODE {self._code(pipe)}", *about[1:-1], f"UCI {name}"])
        yield from _record("TEE-SET-ON", [middle, branch, "SKEY TESO"], about)

    def _flange(self, flange: Flange, about: Sequence[str]) -> Lines:
        ends = self._ends(flange)
        if len(ends) == 1:
            back = tuple(a - flange.length * b for a, b in zip(flange.face, flange.axis, strict=True))
            ends.append(_point("END-POINT", back, _bore(flange, flange.outer_diameter)))
        # what is not in the standard's list has a neck or has not
        key = FLANGE_KEYS.get(flange.flange_type, "FLWN" if flange.length > flange.C else "FLSO")
        yield from _record("FLANGE-BLIND" if key == "FLBL" else "FLANGE", [*ends, f"SKEY {key}"], about)

    def _bolted(self, joint: BoltedJoint) -> Lines:
        """Yield the gasket and the bolts between two flanges, as far as they are known."""
        bore = _bore(joint.a, joint.a.outer_diameter)
        if joint.has_gasket:
            faces = [_point("END-POINT", self.places[flange.id, 0], bore) for flange in (joint.a, joint.b)]
            yield from _record("GASKET", faces, [f"ITEM-CODE {self._code(gasket_of(joint))}"])
        bolts, item = joint.bolts, bolts_of(joint)
        if bolts is not None and item is not None:
            middle = tuple((a + b) / 2 for a, b in zip(joint.a.face, joint.b.face, strict=True))
            sizes = [f"BOLT-DIA {bolts.diameter:g}", f"BOLT-LENGTH {bolts.length:g}", f"BOLT-QUANTITY {bolts.count}"]
            yield from _record("BOLT", [_point("CO-ORDS", middle, bore), *sizes], [f"BOLT-ITEM-CODE {self._code(item)}"])

    def _ends(self, component: AnyComponent) -> list[str]:
        """Return a component's ends but a branch's, at the places where they are joined."""
        diameters = [component.outer_diameter if isinstance(component, Flange) else port.diameter for port in component.ports[:2]]
        return [_point("END-POINT", self.places[component.id, number], _bore(component, one)) for number, one in enumerate(diameters)]

    def _about(self, component: AnyComponent) -> list[str]:
        """Return what is said of every component: its item, its insulation, its name."""
        said = [f"ITEM-CODE {self._code(item_of(component))}"]
        build = self.builds.get(component.id)
        if build is not None:
            thickness = sum(layer.thickness for layer in build[0])
            said += ["INSULATION ON", f"INSULATION-SPEC {_word(build_text(build))}", f"COMPONENT-ATTRIBUTE1 {thickness:g}"]
        return [*said, f"UCI {self.names[component.id]}"]

    def _code(self, item: Item) -> str:
        """Return an item's code, such as ``PIPE-1``: counted in the order in which items come."""
        if item not in self.codes:
            number = 1 + sum(known.kind == item.kind for known in self.codes)
            self.codes[item] = f"{item.kind.upper()}-{number}"
        return self.codes[item]


def _places(pipeline: Pipeline, bolted: Sequence[BoltedJoint]) -> dict[End, Vector]:
    """Return where the ends of components are: joined ones in one place, faces with a gasket between them where they are."""
    places = dict(network_of(pipeline.components, pipeline.joints, pipeline.frame).places)
    for joint in bolted:
        if joint.has_gasket:
            places |= {(flange.id, 0): flange.face for flange in (joint.a, joint.b)}
    return places


def _record(kind: str, *parts: Sequence[str]) -> Lines:
    yield kind
    for part in parts:
        yield from (INDENT + line for line in part)


def _point(key: str, place: Sequence[float], bore: str) -> str:
    # nothing below zero is written as zero
    x, y, z = (f"{round(value, COORDINATE_DIGITS) + 0.0:.{COORDINATE_DIGITS}f}" for value in place)
    return f"{key} {x} {y} {z} {bore}"


def _bore(component: AnyComponent, diameter: float) -> str:
    """Return the nominal diameter of an end of a component with an outside diameter (mm), the outside diameter where none is known."""
    if component.dn and diameter == component.outer_diameter:
        return str(component.dn)
    size = pipe_size(diameter)
    return str(size.dn) if size else f"{round(diameter, 1):g}"


def _flat_side(reducer: Reducer) -> str:
    """Return to which side an eccentric reducer is flat: where its narrow end is offset to."""
    offset = [b - a - reducer.length * c for a, b, c in zip(reducer.start, reducer.end, reducer.axis, strict=True)]
    across = max(range(3), key=lambda axis: abs(offset[axis]))
    return SIDES[2 * across + (offset[across] < 0)]


def _title(run: str, components: Sequence[AnyComponent]) -> str:
    """Return what people call a pipeline, where a component says it; else the run's name."""
    return next((name for one in components if isinstance(name := one.extra.get(SYSTEM), str) and name), run)


def _description(item: Item) -> str:
    """Return an item in one line: what it is, its wall, standard and material."""
    wall = f"wall {item.wall_thickness:g} mm" if item.wall_thickness else None
    return _plain(", ".join(filter(None, (item.description, wall, item.standard, item.material))))


def _plain_names(names: Iterable[str]) -> dict[str, str]:
    """Return names as words of ASCII, no two alike."""
    found: dict[str, str] = {}
    used: set[str] = set()
    for name in names:
        found[name] = free_id(_word(name), used)
        used.add(found[name])
    return found


def _word(text: str) -> str:
    """Return a text as one word of ASCII."""
    return "-".join(_plain(text).split()) or "_"


def _plain(text: str) -> str:
    """Return a text in printable ASCII: letters without their accents, everything else as an underscore."""
    bare = (letter for letter in unicodedata.normalize("NFKD", text) if not unicodedata.combining(letter))
    return "".join(letter if letter.isascii() and letter.isprintable() else "_" for letter in bare)
