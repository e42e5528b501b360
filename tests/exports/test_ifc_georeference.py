# SPDX-License-Identifier: LGPL-2.1-or-later
"""IFC of a pipeline that was put into a plant's or a country's coordinates: every reader finds it at its place on the map."""

import ifc_checks as checks
import ifcopenshell
import numpy as np
import pytest
from ifcopenshell.util.geolocation import auto_xyz2enh
from ifcopenshell.util.placement import get_local_placement
from pipe_rack import pipe_rack

from pipeworkbench.exports.ifc import SCHEMAS, IfcOptions, ifc_model, write_ifc
from pipeworkbench.recon.plant import placed

TURN = np.radians(33.0)
SHIFTS = {"near": (12_000.0, -7_000.0, 300.0), "UTM": (389_123_456.7, 5_820_111_222.3, 34_567.8)}  # mm
CLOSE_MM = 0.01  # of coordinates in mm that have ten digits before the point
RACK = pipe_rack(20)
everywhere = pytest.mark.parametrize("where", SHIFTS)


def at(where):
    cosine, sine = np.cos(TURN), np.sin(TURN)
    x, y, z = SHIFTS[where]
    return placed(RACK, ((cosine, -sine, 0.0, x), (sine, cosine, 0.0, y), (0.0, 0.0, 1.0, z), (0.0, 0.0, 0.0, 1.0)), "EPSG:25833")


@everywhere
@pytest.mark.parametrize("schema", SCHEMAS)
def test_components_lie_on_the_map_where_they_were_placed(tmp_path, schema, where):
    path, pipeline = tmp_path / "rack.ifc", at(where)
    write_ifc(pipeline, path, IfcOptions(schema))
    model = ifcopenshell.open(str(path))
    (conversion,) = model.by_type("IfcMapConversion")
    assert conversion.Scale == 0.001
    assert conversion.TargetCRS.Name == "EPSG:25833"
    products = checks.products_by_tag(model)
    for component in pipeline.pipes:
        origin = get_local_placement(products[component.id].ObjectPlacement)[:3, 3]
        assert np.abs(origin).max() < 2e7  # viewers have single precision
        east, north, height = auto_xyz2enh(model, *origin)
        # the conversion's scale makes metres of the file's millimetres
        assert np.array([east, north, height]) * 1000 == pytest.approx(np.array(component.start), abs=CLOSE_MM)


@everywhere
def test_georeferenced_file_is_valid_and_its_bodies_are_right(tmp_path, where):
    path, pipeline = tmp_path / "rack.ifc", at(where)
    write_ifc(pipeline, path)
    assert checks.command_faults(path, rules=False) == []
    volumes = {name: body.volume for name, body in checks.occ_bodies(ifcopenshell.open(str(path))).items()}
    truth = {component.id: checks.true_body(component).volume for component in RACK.components}
    assert volumes == pytest.approx(truth, rel=5e-4)


@everywhere
def test_placing_changes_no_global_id(where):
    models = [ifc_model(pipeline) for pipeline in (RACK, at(where))]
    was, now = ({item.GlobalId for item in model.by_type("IfcRoot")} for model in models)
    assert was == now


def test_without_a_georeference_there_is_no_place_on_the_map():
    model = ifc_model(RACK)
    assert not model.by_type("IfcMapConversion")
    assert not model.by_type("IfcProjectedCRS")
