# SPDX-License-Identifier: LGPL-2.1-or-later
"""IFC: insulation, georeference, systems with names, and components put into others' models."""

import dataclasses
import math

import ifcopenshell
import ifcopenshell.geom
import ifcopenshell.util.element
import ifcopenshell.util.placement
import ifcopenshell.validate
import numpy as np
import pytest
from measured import DN40

from pipeworkbench.errors import InputError
from pipeworkbench.exports.ifc import SCHEMAS, IfcOptions, ifc_model
from pipeworkbench.exports.ifc_into import add_component
from pipeworkbench.pipeline import Pipeline
from pipeworkbench.recon.plant import placed

INSULATED = dataclasses.replace(DN40, extra={"insulation": {"thickness": 30, "material": "Mineral wool"}})


def findings(model):
    logger = ifcopenshell.validate.json_logger()
    ifcopenshell.validate.validate(model, logger)
    return logger.statements


def of(component, **extra):
    return Pipeline(frame="A", components=(component,), extra=extra)


def test_thick_insulation_is_written_where_it_does_not_fit_into_a_bend_or_under_a_branch(everything):
    thick = {"insulation": {"thickness": 80, "material": "Mineral wool"}}
    model = ifc_model(dataclasses.replace(everything, components=tuple(dataclasses.replace(one, extra=thick) for one in everything.components)))
    assert findings(model) == []
    assert len(model.by_type("IfcCovering")) == len(everything.components)
    settings = ifcopenshell.geom.settings()
    assert all(len(ifcopenshell.geom.create_shape(settings, item).geometry.faces) for item in model.by_type("IfcCovering"))


@pytest.mark.parametrize("schema", SCHEMAS)
def test_insulation_is_a_part_of_its_component(everything, schema):
    insulated = tuple(dataclasses.replace(one, extra=INSULATED.extra) for one in everything.components)
    model = ifc_model(dataclasses.replace(everything, components=insulated), options=IfcOptions(schema))
    assert findings(model) == []
    coverings = model.by_type("IfcCovering")
    assert [item.Decomposes[0].RelatingObject.Tag for item in coverings] == [one.id for one in insulated]
    assert {ifcopenshell.util.element.get_predefined_type(item) for item in coverings} == {"INSULATION"}
    assert all(item.ObjectPlacement.PlacementRelTo == item.Decomposes[0].RelatingObject.ObjectPlacement for item in coverings)
    assert not any(item.ContainedInStructure for item in coverings)
    assert not model.by_type("IfcRelCoversBldgElements")


def test_insulation_has_its_thickness_material_and_area():
    model = ifc_model(of(INSULATED))  # entities live as long as their file
    (item,) = model.by_type("IfcCovering")
    profile = item.Representation.Representations[0].Items[0].SweptArea
    assert (profile.Radius, profile.WallThickness) == pytest.approx((48.3 / 2 + 30, 30))
    (layer,) = ifcopenshell.util.element.get_material(item).MaterialLayers
    assert (layer.Material.Name, layer.LayerThickness) == ("Mineral wool", 30)
    found = ifcopenshell.util.element.get_psets(item)["Qto_CoveringBaseQuantities"]
    assert (found["Width"], found["GrossArea"]) == pytest.approx((30, math.pi * 0.1083 * 0.5))


@pytest.mark.parametrize("wrong", [{"thickness": -1, "material": "wool"}, {"thickness": "30", "material": "wool"}, {"thickness": 30}, "wool"])
def test_wrong_insulation_is_refused(wrong):
    with pytest.raises(InputError, match=r"A-P00.*insulation\."):
        ifc_model(of(dataclasses.replace(DN40, extra={"insulation": wrong})))


@pytest.mark.parametrize("offset", [(3500.0, 400.0, 10.0), (3.5e9, 5.4e9, 1e5)])
def test_map_conversion_leads_to_the_plants_coordinates(offset):
    cosine, sine = math.cos(0.6), math.sin(0.6)
    turn = np.array([(cosine, -sine, 0.0), (sine, cosine, 0.0), (0.0, 0.0, 1.0)])
    matrix = (*((*row, shift) for row, shift in zip(turn.tolist(), offset, strict=True)), (0.0, 0.0, 0.0, 1.0))
    pipeline = placed(of(DN40), matrix, "EPSG:25832")
    model = ifc_model(pipeline)
    assert findings(model) == []
    (conversion,), (system,) = model.by_type("IfcMapConversion"), model.by_type("IfcProjectedCRS")
    assert (conversion.Scale, system.Name, system.MapUnit.Name, system.MapUnit.Prefix) == (0.001, "EPSG:25832", "METRE", None)
    (item,) = model.by_type("IfcPipeSegment")
    x, y, z = ifcopenshell.util.placement.get_local_placement(item.ObjectPlacement)[:3, 3]
    east, north = conversion.XAxisAbscissa, conversion.XAxisOrdinate
    on_map = (
        0.001 * (east * x - north * y) + conversion.Eastings,
        0.001 * (north * x + east * y) + conversion.Northings,
        0.001 * z + conversion.OrthogonalHeight,
    )
    assert on_map == pytest.approx(np.array(pipeline.components[0].start) / 1000, abs=1e-6)
    assert max(abs(value) for value in (x, y, z)) < 1e7  # single precision shows no steps


def test_a_pipeline_that_is_placed_keeps_its_global_ids():
    moved = placed(of(DN40), ((1.0, 0.0, 0.0, 5.0), (0.0, 1.0, 0.0, 6.0), (0.0, 0.0, 1.0, 7.0), (0.0, 0.0, 0.0, 1.0)))
    ids = [{item.GlobalId for item in model.by_type("IfcRoot")} for model in (ifc_model(of(DN40)), ifc_model(moved))]
    assert ids[0] == ids[1]


def test_runs_of_one_name_are_one_system():
    other = dataclasses.replace(DN40, id="A-P09", start=(100.0, 9600.0, -50.0), end=(400.0, 9600.0, 350.0))
    named = tuple(dataclasses.replace(one, extra={"system": "Kühlwasser 'Süd'"}) for one in (DN40, other))
    model = ifc_model(Pipeline(frame="A", components=named))
    (system,) = model.by_type("IfcDistributionSystem")
    assert system.Name == "Kühlwasser 'Süd'"
    assert [item.Tag for item in system.IsGroupedBy[0].RelatedObjects] == ["A-P00", "A-P09"]


@pytest.mark.parametrize("schema", SCHEMAS)
def test_components_can_be_put_into_a_model_of_another_program(everything, schema):
    model = ifc_model(Pipeline(frame="other"), options=IfcOptions(schema))
    contexts = len(model.by_type("IfcRepresentationContext"))
    products = [add_component(model, component, "A") for component in everything.components]
    assert [product.Tag for product in products] == [component.id for component in everything.components]
    assert findings(model) == []
    assert len(model.by_type("IfcRepresentationContext")) == contexts
    assert all(ifcopenshell.util.element.get_type(product) for product in products)
    assert len(model.by_type("IfcDistributionPort")) == sum(len(component.ports) for component in everything.components)


def test_components_are_not_put_into_ifc2x3():
    with pytest.raises(InputError, match="IFC2X3"):
        add_component(ifcopenshell.file(schema="IFC2X3"), DN40)
