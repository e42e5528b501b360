# SPDX-License-Identifier: LGPL-2.1-or-later
"""The folder with the user's tables, named in FreeCAD's parameters."""

import FreeCAD
import pytest

from pipeworkbench.catalogue import catalogue, pipe_size, use_folder
from pipeworkbench.errors import InputError
from pipeworkbench.exports.fcstd import write_fcstd
from pipeworkbench.features.document import components_in
from pipeworkbench.features.kinds import add_component
from pipeworkbench.features.preferences import CATALOGUE_FOLDER, PREFERENCES, start_with_preferred_catalogue, use_preferred_catalogue
from pipeworkbench.pipeline import Pipe, Pipeline

PIPE = Pipe(id="p", start=(0.0, 0.0, 0.0), end=(0.0, 0.0, 100.0), outer_diameter=50.5)


@pytest.fixture
def tables(tmp_path):
    """A folder with one table, named in the parameters; afterwards none is."""
    folder = tmp_path / "tables"
    folder.mkdir()
    (folder / "pipes_ours.csv").write_text("outer_diameter,dn,wall_thickness\n50.5,41,3.2\n47,40,3\n", encoding="utf-8")
    parameters = FreeCAD.ParamGet(PREFERENCES)
    parameters.SetString(CATALOGUE_FOLDER, str(folder))
    yield folder
    parameters.RemString(CATALOGUE_FOLDER)
    use_folder(None)


def test_tables_of_the_preferred_folder_are_used_until_it_is_no_longer_named(tables):
    use_preferred_catalogue()
    assert pipe_size(50.5).dn == 41
    FreeCAD.ParamGet(PREFERENCES).RemString(CATALOGUE_FOLDER)
    use_preferred_catalogue()
    assert pipe_size(50.5) is None


def test_pipe_takes_a_size_of_the_users_table(tables, document):
    use_preferred_catalogue()
    obj = add_component(document, PIPE)
    obj.NominalDiameter = "DN 40"
    assert (obj.OutsideDiameter.Value, obj.WallThickness.Value) == (48.3, 2.6)  # the usual one of the two
    obj.NominalDiameter = "DN 41"
    assert (obj.OutsideDiameter.Value, obj.WallThickness.Value) == (50.5, 3.2)
    obj.OutsideDiameter = 60.3
    obj.OutsideDiameter = 50.5
    assert (obj.NominalDiameter, obj.Standard, obj.StandardSources) == ("DN 41", "pipes_ours", "not verified")


def test_second_outside_diameter_of_a_nominal_one_stays_as_it_was_typed(tables, document):
    use_preferred_catalogue()
    obj = add_component(document, PIPE)
    assert obj.getEnumerationsOfProperty("NominalDiameter").count("DN 40") == 1
    for diameter in (47.0, 48.3, 47.0):
        obj.OutsideDiameter = diameter
        assert (obj.NominalDiameter, obj.OutsideDiameter.Value) == ("DN 40", diameter)


def test_wrong_table_is_refused_by_commands_and_does_not_keep_documents_from_opening(tables):
    (tables / "flanges_ours.csv").write_text("D\n-1\n", encoding="utf-8")
    with pytest.raises(InputError, match=r"flanges_ours\.csv: line 1"):
        use_preferred_catalogue()
    start_with_preferred_catalogue()
    assert catalogue().folders == ()


def test_written_document_knows_the_sizes_of_whoever_wrote_it(tables, tmp_path, document):
    use_folder(tables)
    path = tmp_path / "pipes.FCStd"
    write_fcstd(Pipeline.of_station("A", (PIPE,)), path)
    opened = FreeCAD.openDocument(str(path))
    (obj,) = components_in(opened)
    assert obj.NominalDiameter == "DN 41"
