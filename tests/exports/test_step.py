# SPDX-License-Identifier: LGPL-2.1-or-later
"""STEP: what a CAD program reads back has the volumes, places and names of the pipeline."""

import dataclasses
import math
from dataclasses import dataclass

import cadquery
import pytest
from OCP.IFSelect import IFSelect_ReturnStatus
from OCP.Quantity import Quantity_Color, Quantity_TypeOfColor
from OCP.STEPCAFControl import STEPCAFControl_Reader
from OCP.TCollection import TCollection_ExtendedString
from OCP.TDataStd import TDataStd_Name
from OCP.TDF import TDF_Label, TDF_LabelSequence
from OCP.TDocStd import TDocStd_Document
from OCP.TopLoc import TopLoc_Location
from OCP.XCAFDoc import XCAFDoc_ColorType, XCAFDoc_DocumentTool
from planned import plan_of_everything

from pipeworkbench.errors import InputError
from pipeworkbench.exports.kinds import COLOURS, material_colour
from pipeworkbench.exports.step import write_step
from pipeworkbench.pipeline import Elbow, Pipe, Pipeline
from pipeworkbench.solids import component_solid
from pipeworkbench.solids.insulation import placed_bodies

HOLLOW = Pipe(id="A-P00", start=(100.0, 3600.0, -50.0), end=(400.0, 3600.0, 350.0), outer_diameter=48.3, wall_thickness=2.6, dn=40)
MASSIVE = Pipe(id="A-P01", start=(0.0, 4000.0, 0.0), end=(0.0, 4000.0, -700.0), outer_diameter=95.0)


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    path = tmp_path_factory.mktemp("step") / "pipes.step"
    write_step(Pipeline.of_station("A", (HOLLOW, MASSIVE)), path)
    return path


def test_volumes_are_those_of_the_pipes(written):
    solids = cadquery.importers.importStep(str(written)).solids().vals()
    hollow = math.pi / 4 * (48.3**2 - 43.1**2) * 500
    massive = math.pi / 4 * 95.0**2 * 700
    assert sorted(solid.Volume() for solid in solids) == pytest.approx(sorted([hollow, massive]), rel=1e-6)


def test_solids_lie_where_the_pipes_are(written):
    solids = sorted(cadquery.importers.importStep(str(written)).solids().vals(), key=lambda solid: solid.Volume())
    for solid, pipe in zip(solids, (HOLLOW, MASSIVE), strict=True):
        middle = [(a + b) / 2 for a, b in zip(pipe.start, pipe.end, strict=True)]
        assert solid.Center().toTuple() == pytest.approx(middle, abs=1e-4)


def test_names_and_the_unit_are_in_the_file(written):
    text = written.read_text(encoding="ascii")
    assert "'A-P00'" in text
    assert "'A-P01'" in text
    assert "SI_UNIT(.MILLI.,.METRE.)" in text.replace(" ", "")


@pytest.mark.slow
def test_all_kinds_are_written_with_their_volumes_names_and_colours(everything, tmp_path):
    path = tmp_path / "all.step"
    write_step(everything, path)
    found = cadquery.importers.importStep(str(path)).solids().vals()
    volumes = sorted(component_solid(component).Volume() for component in everything.components)
    assert sorted(solid.Volume() for solid in found) == pytest.approx(volumes, rel=1e-5)
    text = path.read_text(encoding="ascii")
    assert all(f"'{component.id}'" in text for component in everything.components)
    assert text.count("COLOUR_RGB(") >= len(COLOURS)


# ---------------------------------------------------------------- the assembly, as Open CASCADE reads it


@dataclass
class Node:
    """A part or an assembly of a STEP file: its name, its colour, its shape in the file's frame, what is in it."""

    name: str
    colour: tuple[float, float, float] | None
    shape: cadquery.Shape
    children: list["Node"]

    def every(self):
        """Yield the node and all that is in it."""
        yield self
        for child in self.children:
            yield from child.every()


def read_assembly(path):
    """Return the root of a STEP file's assembly, by Open CASCADE's own reader of names and colours."""
    document = TDocStd_Document(TCollection_ExtendedString("XmlOcaf"))
    reader = STEPCAFControl_Reader()
    reader.SetNameMode(True)
    reader.SetColorMode(True)
    assert reader.ReadFile(str(path)) == IFSelect_ReturnStatus.IFSelect_RetDone
    assert reader.Transfer(document)
    shapes = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
    colours = XCAFDoc_DocumentTool.ColorTool_s(document.Main())
    free = TDF_LabelSequence()
    shapes.GetFreeShapes(free)
    assert free.Length() == 1
    return read_node(shapes, colours, free.Value(1), TopLoc_Location())


def read_node(shapes, colours, label, place):
    name, colour = TDataStd_Name(), Quantity_Color()
    assert label.FindAttribute(TDataStd_Name.GetID_s(), name)
    target = TDF_Label()
    here = place
    if shapes.GetReferredShape_s(label, target):
        here = place.Multiplied(shapes.GetLocation_s(label))
    else:
        target = label
    has_colour = colours.GetColor_s(target, XCAFDoc_ColorType.XCAFDoc_ColorSurf, colour)
    parts = TDF_LabelSequence()
    shapes.GetComponents_s(target, parts)
    children = [read_node(shapes, colours, parts.Value(number), here) for number in range(1, parts.Length() + 1)]
    rgb = tuple(round(value, 3) for value in colour.Values(Quantity_TypeOfColor.Quantity_TOC_sRGB)) if has_colour else None
    shape = cadquery.Shape.cast(shapes.GetShape_s(target)).moved(cadquery.Location(here))
    return Node(name.Get().ToExtString(), rgb, shape, children)


@pytest.fixture(scope="module")
def insulated(everything, tmp_path_factory):
    """The plan by hand and the assembly that is read back."""
    path = tmp_path_factory.mktemp("insulated") / "insulated.step"
    plan = plan_of_everything(everything)
    write_step(everything, path, plan)
    return plan, read_assembly(path)


@pytest.mark.slow
def test_runs_and_components_are_nodes_of_the_pipework(everything, insulated):
    _, root = insulated
    assert root.name == everything.frame
    assert [child.name for child in root.children] == ["Pipework", "Insulation"]
    (run,) = root.children[0].children
    assert run.name == "Run R1"
    assert [child.name for child in run.children] == [component.id for component in everything.components]
    assert [child.colour for child in run.children] == [COLOURS[type(component)] for component in everything.components]


@pytest.mark.slow
def test_layers_and_jacket_are_bodies_of_their_covering(insulated):
    plan, root = insulated
    coverings = root.children[1].children
    assert [child.name for child in coverings] == [piece.covering.id for piece in plan.pieces]
    for node, piece in zip(coverings, plan.pieces, strict=True):
        bodies = placed_bodies(piece.covering)
        assert [child.name for child in node.children] == [f"{piece.covering.id} {body.name}" for body in bodies]
        assert [child.shape.Volume() for child in node.children] == pytest.approx([body.solid.Volume() for body in bodies], rel=1e-6)
        for child, body in zip(node.children, bodies, strict=True):
            assert child.shape.Center().toTuple() == pytest.approx(body.solid.Center().toTuple(), abs=1e-4)
            assert child.colour == pytest.approx(material_colour(body.material, jacket=body.name.startswith("jacket")), abs=2e-3)


@pytest.mark.slow
def test_no_two_names_are_alike(insulated):
    _, root = insulated
    names = [node.name for node in root.every()]
    assert len(set(names)) == len(names)


def test_names_that_the_assembly_uses_itself_stay_the_components(tmp_path):
    named = tuple(dataclasses.replace(MASSIVE, id=name) for name in ("Pipework", "A", "Run R1", "Rücklauf 'Süd'"))
    path = tmp_path / "named.step"
    write_step(Pipeline.of_station("A", named), path)
    leaves = [node.name for node in read_assembly(path).every() if not node.children]
    assert leaves == [pipe.id for pipe in named]


def test_coverings_of_components_that_are_not_written_are_left_out(everything, tmp_path):
    part = dataclasses.replace(everything, components=tuple(one for one in everything.components if one.id in {"P1", "E1"}), joints=())
    path = tmp_path / "part.step"
    write_step(part, path, plan_of_everything(everything))
    assert [child.name for child in read_assembly(path).children[1].children] == ["I-P1", "I-E1"]


def test_pipeline_without_components_is_refused_and_nothing_written(tmp_path):
    with pytest.raises(InputError, match="no components"):
        write_step(Pipeline(frame="A"), tmp_path / "empty.step")
    assert list(tmp_path.iterdir()) == []


def test_component_that_makes_no_solid_is_refused_with_its_id(tmp_path):
    elbow = Elbow(
        id="E7", start=(0.0, 0.0, 0.0), end=(57.0, 57.0, 0.0), intersection=(57.0, 0.0, 0.0), angle_deg=90.0, bend_radius=20.0, outer_diameter=48.3
    )
    with pytest.raises(InputError, match="E7"):
        write_step(Pipeline(frame="A", components=(HOLLOW, elbow)), tmp_path / "elbow.step")
    assert list(tmp_path.iterdir()) == []
