# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the colours of components say; the window itself is tested in tests/gui."""

import dataclasses
from pathlib import Path

import pytest

from pipeworkbench.errors import InputError
from pipeworkbench.exports.kinds import COLOURS
from pipeworkbench.features.document import add_pipeline
from pipeworkbench.features.preferences import preferences
from pipeworkbench.features.project import COLOUR_MODES, project_of
from pipeworkbench.gui.colours import colour_of, legend_of
from pipeworkbench.gui.view_providers import colour_by, colour_mode, recolour
from pipeworkbench.pipeline import Pipeline

EVERYTHING = Pipeline.read(Path(__file__).resolve().parent.parent / "data" / "one_of_everything.json")


@pytest.fixture
def objects(document):
    """One of everything, with all qualities there are."""
    qualities = (0.0, 0.3, 0.31, 0.7, 4.0, None)
    levels = ("LOA50", "LOA40", "LOA30", "LOA20", "LOA10", None)
    components = tuple(
        dataclasses.replace(component, quality=qualities[number % 6], loa=levels[number % 6])
        for number, component in enumerate(EVERYTHING.components)
    )
    return add_pipeline(document, dataclasses.replace(EVERYTHING, components=components))


def test_mode_is_remembered_in_the_document(objects, document):
    assert colour_mode(document) == "kind"
    legend = colour_by(document, "quality")
    assert (project_of(document).ColourMode, colour_mode(document)) == ("quality", "quality")
    assert legend == legend_of("quality")


def test_other_colours_of_the_user_add_nothing_to_a_document(objects, document):
    before = [obj.Name for obj in document.Objects]
    recolour(document)
    assert project_of(document) is None
    assert [obj.Name for obj in document.Objects] == before


def test_unknown_mode_is_refused(document):
    with pytest.raises(InputError, match="choose one of kind, quality, loa"):
        colour_by(document, "price")


def test_quality_goes_from_good_to_bad(objects):
    legend = [entry.colour for entry in legend_of("quality")]
    seen = [colour_of(obj, "quality") for obj in objects[:6]]
    assert seen == [legend[0], legend[0], legend[1], legend[2], legend[3], preferences().unknown_colour]
    assert legend_of("quality")[1].text == "0.3 to 0.6 px"


def test_level_of_accuracy_has_a_colour_each(objects):
    assert [colour_of(obj, "loa") for obj in objects[:6]] == [entry.colour for entry in legend_of("loa")]


def test_kinds_have_their_colours_and_approximate_pipes_their_own(objects):
    by_id = {obj.ComponentId: obj for obj in objects}
    assert colour_of(by_id["E1"], "kind") == COLOURS[by_id["E1"].Proxy.kind]
    assert colour_of(by_id["P4"], "kind") == preferences().approximate_colour


@pytest.mark.parametrize("mode", COLOUR_MODES)
def test_every_colour_is_in_the_legend_once(objects, mode):
    colours = [entry.colour for entry in legend_of(mode)]
    assert len(set(colours)) == len(colours)
    assert {colour_of(obj, mode) for obj in objects} <= set(colours)
