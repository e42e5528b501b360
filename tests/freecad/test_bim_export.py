# SPDX-License-Identifier: LGPL-2.1-or-later
"""FreeCAD's own BIM exporter writes pipes and fittings as what they are."""

from pathlib import Path

import ifcopenshell
import pytest

from pipeworkbench.features.document import add_pipeline
from pipeworkbench.pipeline import Pipeline

EVERYTHING = Pipeline.read(Path(__file__).resolve().parent.parent / "data" / "one_of_everything.json")


def test_freecads_exporter_gives_components_their_ifc_classes(document, tmp_path):
    exporter = pytest.importorskip("exportIFC", reason="this FreeCAD has no Arch workbench")
    objects = add_pipeline(document, EVERYTHING)
    document.recompute()
    path = tmp_path / "by_freecad.ifc"
    exporter.export(objects, str(path))
    model = ifcopenshell.open(str(path))
    pipes = [component for component in EVERYTHING.components if component.kind == "pipe"]
    assert len(model.by_type("IfcPipeSegment")) == len(pipes)
    assert len(model.by_type("IfcPipeFitting")) == len(EVERYTHING.components) - len(pipes)
    assert not model.by_type("IfcBuildingElementProxy")


def test_components_add_themselves_to_a_model(document):
    model = ifcopenshell.file(schema="IFC4")
    objects = add_pipeline(document, EVERYTHING)
    document.recompute()
    made = [obj.Proxy.export_ifc(obj, model) for obj in objects]
    assert [product.Tag for product in made] == [component.id for component in EVERYTHING.components]
    assert {product.is_a() for product in made} == {"IfcPipeSegment", "IfcPipeFitting"}
