# SPDX-License-Identifier: LGPL-2.1-or-later
"""STEP of pipework and insulation read by FreeCAD: the same solids, volumes and names as were written, in the same structure."""

from pathlib import Path

import Import
import pytest

from pipeworkbench.exports.step import write_step
from pipeworkbench.insulation.planning import plan
from pipeworkbench.insulation.specification import Specification
from pipeworkbench.pipeline import Pipeline
from pipeworkbench.solids import component_solid
from pipeworkbench.solids.insulation import covering_bodies

EVERYTHING = Pipeline.read(Path(__file__).resolve().parent.parent / "data" / "one_of_everything.json")
THICKNESS_MM = 20.0
ONE_DOCUMENT = 1  # Import's mode that keeps the assembly's tree; without it FreeCAD 0.20 crashes where there is no window


@pytest.fixture
def read_back(document, tmp_path):
    """The plan, and the objects that FreeCAD makes of its STEP file by their labels."""
    made = plan(EVERYTHING, Specification.uniform(THICKNESS_MM))
    path = tmp_path / "insulated.step"
    write_step(EVERYTHING, path, made)
    import_hidden, merge, link_groups = True, False, False
    Import.insert(str(path), document.Name, import_hidden, merge, link_groups, ONE_DOCUMENT)
    objects = {obj.Label: obj for obj in document.Objects if obj.TypeId in {"Part::Feature", "App::Part"}}
    return made, objects


def test_freecad_reads_every_solid_with_its_name_and_volume(read_back):
    made, objects = read_back
    wanted = {component.id: component_solid(component).Volume() for component in EVERYTHING.components}
    for piece in made.pieces:
        wanted |= {f"{piece.covering.id} {body.name}": body.solid.Volume() for body in covering_bodies(piece.covering)}
    found = {label: obj.Shape for label, obj in objects.items() if obj.TypeId == "Part::Feature"}
    assert set(found) == set(wanted)
    assert all(len(shape.Solids) == 1 and shape.isValid() for shape in found.values())
    assert {label: shape.Volume for label, shape in found.items()} == pytest.approx(wanted, rel=1e-6)


def test_freecad_reads_the_structure(read_back):
    made, objects = read_back
    (top,) = (obj for obj in objects.values() if obj.TypeId == "App::Part" and obj.Label == EVERYTHING.frame)
    assert [child.Label for child in top.Group] == ["Pipework", "Insulation"]
    assert [child.Label for child in objects["Pipework"].Group] == ["Run R1"]
    assert [child.Label for child in objects["Run R1"].Group] == [component.id for component in EVERYTHING.components]
    nodes = objects["Insulation"].Group
    assert len(nodes) == len(made.pieces)
    for node, piece in zip(nodes, made.pieces, strict=True):
        assert [child.Label for child in node.Group] == [f"{piece.covering.id} {body.name}" for body in covering_bodies(piece.covering)]


def test_freecad_puts_every_solid_where_it_is(read_back):
    _, objects = read_back
    for component in EVERYTHING.components:
        obj = objects[component.id]
        assert tuple(obj.getGlobalPlacement().multiply(obj.Placement.inverse()).multVec(obj.Shape.CenterOfMass)) == pytest.approx(
            component_solid(component).Center().toTuple(), abs=1e-4
        )
