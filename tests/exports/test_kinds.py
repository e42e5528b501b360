# SPDX-License-Identifier: LGPL-2.1-or-later
"""The colours of insulation: by what the material's name says."""

import pytest

from pipeworkbench.exports.kinds import INSULATION_COLOUR, JACKET_COLOUR, material_colour


@pytest.mark.parametrize(
    ("name", "other"),
    [("Mineral wool", "Steinwolle 100 kg/m³"), ("PIR", "Polyisocyanurate foam"), ("aluminium", "Alu-Blech"), ("galvanised steel", "Stahlblech")],
)
def test_names_of_one_material_have_one_colour(name, other):
    assert material_colour(name) == material_colour(other)


def test_materials_are_told_apart():
    names = ("mineral wool", "glass wool", "elastomeric foam", "polyurethane foam", "foam glass", "calcium silicate")
    sheets = ("aluminium", "stainless steel", "galvanised steel")
    assert len({material_colour(name) for name in (*names, *sheets)}) == len(names) + len(sheets)


def test_a_word_within_a_word_names_no_material():
    assert material_colour("spiral shells") == INSULATION_COLOUR  # not PIR


def test_unknown_materials_have_the_colour_of_what_they_are_used_for():
    assert material_colour("xyz") == INSULATION_COLOUR
    assert material_colour("xyz", jacket=True) == JACKET_COLOUR
