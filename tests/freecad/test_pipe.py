# SPDX-License-Identifier: LGPL-2.1-or-later
"""The parametric pipe in a document, without a window."""

import math

import FreeCAD
import pytest

from pipeworkbench.errors import PipeWorkbenchError
from pipeworkbench.features.component import component_of
from pipeworkbench.features.document import add_pipeline, components_in, pipeline_of
from pipeworkbench.features.kinds import add_component
from pipeworkbench.pipeline import Pipe, Pipeline

DN40 = Pipe(
    id="A-P00", start=(100.0, 3600.0, -50.0), end=(100.0, 3900.0, 350.0), outer_diameter=48.3, wall_thickness=2.6, dn=40,
    standard="EN 10220", verified=2, pick=0, station="A", quality=0.4, sigma_position=(0.1, 0.3, 0.05), sigma_direction_deg=0.02,
    sigma_outer_diameter=0.03, loa="LOA40", gaps=((100.0, 150.5), (300.0, 320.0)), nearest_standard="DN 40", extra={"note": "kept"},
)  # fmt: skip


def volume(outer, wall, length):
    return math.pi / 4 * (outer**2 - (outer - 2 * wall) ** 2) * length


def test_pipe_is_hollow_and_lies_between_its_ends(document):
    obj = add_component(document, DN40)
    document.recompute()
    assert obj.Shape.isValid()
    assert obj.Shape.Volume == pytest.approx(volume(48.3, 2.6, 500), rel=1e-6)
    middle = obj.Shape.CenterOfMass
    assert tuple(middle) == pytest.approx((100, 3750, 150), abs=1e-6)


def test_bridged_gaps_belong_to_the_measurement(document):
    obj = add_component(document, DN40)
    assert (component_of(obj).gaps, component_of(obj).nearest_standard) == (DN40.gaps, DN40.nearest_standard)
    obj.Length = "1.2 m"
    assert (component_of(obj).gaps, component_of(obj).nearest_standard) == (None, None)


def test_solid_follows_the_properties(document):
    obj = add_component(document, DN40)
    obj.Length = "1.2 m"
    obj.WallThickness = 5
    document.recompute()
    assert obj.Shape.Volume == pytest.approx(volume(48.3, 5, 1200), rel=1e-6)
    assert component_of(obj).length == pytest.approx(1200)


def test_unknown_wall_makes_a_massive_pipe(document):
    obj = add_component(document, DN40)
    obj.WallThickness = 0
    document.recompute()
    assert obj.Shape.Volume == pytest.approx(math.pi / 4 * 48.3**2 * 500, rel=1e-6)


def test_choosing_a_nominal_diameter_sets_diameter_and_wall(document):
    obj = add_component(document, DN40)
    obj.NominalDiameter = "DN 100"
    document.recompute()
    assert obj.OutsideDiameter.Value == pytest.approx(114.3)
    assert obj.WallThickness.Value == pytest.approx(3.6)
    assert obj.Standard == "EN 10220"


def test_typed_diameter_finds_its_nominal_diameter_or_none(document):
    obj = add_component(document, DN40)
    obj.OutsideDiameter = 60.3
    assert obj.NominalDiameter == "DN 50"
    obj.OutsideDiameter = 61.7
    assert obj.NominalDiameter == "none"
    assert obj.Standard == ""


def test_expression_drives_the_diameter(document):
    obj = add_component(document, DN40)
    sheet = document.addObject("Spreadsheet::Sheet", "Sheet")
    sheet.set("A1", "=88.9 mm")
    document.recompute()
    obj.setExpression("OutsideDiameter", "Sheet.A1")
    document.recompute()
    assert obj.OutsideDiameter.Value == pytest.approx(88.9)
    assert obj.NominalDiameter == "DN 80"
    assert obj.Shape.BoundBox.XLength == pytest.approx(88.9, rel=1e-3)


def test_impossible_wall_is_an_error_of_the_object_not_a_wrong_solid(document):
    obj = add_component(document, DN40)
    document.recompute()
    obj.WallThickness = 30
    document.recompute()
    assert "Invalid" in obj.State


def test_save_close_reopen_recompute_gives_the_same_document(document, tmp_path):
    add_component(document, DN40)
    document.recompute()
    before = [component_of(obj) for obj in components_in(document)]
    shape = components_in(document)[0].Shape.Volume
    path = str(tmp_path / "pipes.FCStd")
    document.saveAs(path)
    FreeCAD.closeDocument(document.Name)
    again = FreeCAD.openDocument(path)
    assert [component_of(obj) for obj in components_in(again)] == before
    again.recompute(None, True)
    assert [component_of(obj) for obj in components_in(again)] == before
    assert components_in(again)[0].Shape.Volume == pytest.approx(shape, rel=1e-12)


def test_component_survives_the_way_through_a_document(document):
    obj = add_component(document, DN40)
    back = component_of(obj)
    assert back.start == pytest.approx(DN40.start)
    assert back.end == pytest.approx(DN40.end)
    for name in ("id", "dn", "standard", "verified", "pick", "station", "loa", "extra", "wall_thickness", "quality", "sigma_position"):
        assert getattr(back, name) == getattr(DN40, name)


def test_reconstructing_again_updates_in_place_and_leaves_fixed_pipes(document):
    first = add_pipeline(document, Pipeline.of_station("A", (DN40,)))[0]
    longer = Pipe(**{**vars(DN40), "end": (100.0, 4200.0, 750.0)})
    second = add_pipeline(document, Pipeline.of_station("A", (longer,)))[0]
    assert second is first
    assert first.Length.Value == pytest.approx(1000)
    first.Fixed = True
    add_pipeline(document, Pipeline.of_station("A", (DN40,)))
    assert first.Length.Value == pytest.approx(1000)


def test_undo_takes_a_pipe_back(document):
    document.openTransaction("add")
    add_component(document, DN40)
    document.commitTransaction()
    document.undo()
    assert not components_in(document)
    document.redo()
    assert len(components_in(document)) == 1


def test_document_without_pipes_says_so(document):
    with pytest.raises(PipeWorkbenchError, match="has no pipes"):
        pipeline_of(document)


def test_object_of_an_older_version_gets_what_it_lacks(document, tmp_path):
    obj = add_component(document, DN40)
    obj.removeProperty("Fixed")
    obj.Proxy.onDocumentRestored(obj)
    assert obj.Fixed is False


def test_pipe_that_the_user_changed_is_not_exported_as_measured(document):
    obj = add_component(document, DN40)
    obj.Length = 700
    changed = component_of(obj)
    assert changed.length == pytest.approx(700)
    assert (changed.quality, changed.sigma_position, changed.loa) == (None, None, None)


def test_typed_standard_diameter_brings_its_wall(document):
    obj = add_component(document, DN40)
    obj.OutsideDiameter = 114.3
    assert obj.WallThickness.Value == pytest.approx(3.6)


def test_pipes_of_unmerged_stations_are_not_mixed(document):
    add_component(document, DN40)
    add_component(document, Pipe(**{**vars(DN40), "id": "B-P00", "station": "B"}))
    with pytest.raises(PipeWorkbenchError, match="several stations"):
        pipeline_of(document)
