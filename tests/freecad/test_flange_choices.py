# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the catalogue offers in a document: choosing type, PN, standard or bend sets all dimensions."""

import dataclasses
from pathlib import Path

import FreeCAD
import pytest

from pipeworkbench.catalogue import catalogue
from pipeworkbench.features import component_of, make_elbow, make_flange
from pipeworkbench.pipeline import Pipeline

BY_ID = {
    component.id: component for component in Pipeline.read(Path(__file__).resolve().parent.parent / "data" / "one_of_everything.json").components
}


def row_of(**wanted):
    return catalogue().flanges(**wanted)[0]


def dimensions(thing):
    return thing.D, thing.K, thing.L, thing.bolts, thing.C, thing.length, thing.neck_diameter, thing.neck_straight


@pytest.fixture
def flange(document):
    """A weld neck flange of DN 50, PN 16."""
    return make_flange(document, BY_ID["F1"])


def test_pressure_class_sets_all_dimensions_and_the_face_stays(flange):
    face = flange.Placement.Base
    flange.PN = "PN 63"
    component = component_of(flange)
    assert dimensions(component) == dimensions(row_of(standard="EN 1092-1", flange_type="11", pn=63.0, dn=50))
    assert (component.pn, component.standard, flange.PressureClass) == (63, "EN 1092-1", 63)
    assert flange.Placement.Base.isEqual(face, 1e-9)
    assert component.raised_face_height == 3


def test_typed_pressure_class_is_that_of_the_enumeration(flange):
    flange.PressureClass = 40
    assert flange.PN == "PN 40"
    assert component_of(flange).length == row_of(standard="EN 1092-1", flange_type="11", pn=40.0, dn=50).length


def test_equivalents_are_those_of_the_chosen_flange(flange):
    flange.PN = "PN 40"
    assert {"standard": "DIN 2635", "flange_type": "11", "pn": 40.0} in component_of(flange).equivalents
    assert "DIN 2635 11 40.0" in flange.Equivalents


def test_type_sets_all_dimensions(flange):
    flange.FlangeType = "12"
    row = row_of(standard="EN 1092-1", flange_type="12", pn=16.0, dn=50)
    assert dimensions(component_of(flange)) == dimensions(row)
    flange.FlangeType = "05"
    assert len(component_of(flange).ports) == 1


def test_type_whose_dimensions_are_not_known_keeps_those_it_has(flange):
    # the thickness of this plate flange is in no public source
    flange.FlangeType = "01"
    assert (flange.Standard, flange.PlateThickness.Value) == ("none", 18)


def test_standard_sets_what_it_knows(flange):
    flange.Standard = "DIN 2635"
    component = component_of(flange)
    assert (component.standard, component.pn, component.flange_type) == ("DIN 2635", 40, "11")
    assert dimensions(component)[:4] == dimensions(row_of(standard="DIN 2635", dn=50))[:4]
    assert flange.PN == "PN 40"


def test_changed_dimension_is_of_no_standard(flange):
    flange.PlateDiameter = 166
    assert (flange.Standard, component_of(flange).standard, component_of(flange).equivalents) == ("none", None, ())


def test_type_that_the_catalogue_does_not_know_is_kept(document):
    strange = dataclasses.replace(BY_ID["F3"], flange_type="SAE", standard="SAE J518")
    obj = make_flange(document, strange)
    assert (obj.FlangeType, obj.Standard) == ("SAE", "SAE J518")
    assert component_of(obj) == strange


def test_bend_that_the_catalogue_does_not_have_is_refused(document):
    elbow = make_elbow(document, BY_ID["E1"])
    elbow.OutsideDiameter = 47.1
    assert elbow.BendType == "none"
    elbow.BendType = "3D"
    assert (elbow.BendType, elbow.BendRadius.Value) == ("none", 57)
    elbow.OutsideDiameter = 60.3
    elbow.BendType = "3D"
    assert (elbow.BendType, elbow.BendRadius.Value) == ("3D", 76)


def test_enumerations_keep_their_choice_when_the_document_is_saved(document, flange, tmp_path):
    flange.PN = "PN 25"
    before = component_of(flange)
    document.recompute()
    document.saveAs(str(tmp_path / "flange.FCStd"))
    FreeCAD.closeDocument(document.Name)
    (again,) = FreeCAD.openDocument(str(tmp_path / "flange.FCStd")).Objects
    assert (again.PN, again.FlangeType, again.Standard) == ("PN 25", "11", "EN 1092-1")
    assert component_of(again) == before
