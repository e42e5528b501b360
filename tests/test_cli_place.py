# SPDX-License-Identifier: LGPL-2.1-or-later
"""`pipeworkbench place`: into the plant's coordinates."""

import csv
import json
import subprocess
import sys

import numpy as np
import pytest

from pipeworkbench.cli import main
from pipeworkbench.pipeline import Pipe, Pipeline
from pipeworkbench.recon.plant import placed

SIZES = ((60.3, 50), (88.9, 80), (114.3, 100), (48.3, 40))
ENDS = (
    ((0, 3000, 0), (1500, 3000, 0)),
    ((200, 3200, 100), (200, 3200, 1400)),
    ((-400, 2800, 300), (-400, 4100, 300)),
    ((0, 3500, 900), (900, 3500, 900)),
)


@pytest.fixture
def pipeline():
    pipes = tuple(
        Pipe(id=f"P{row}", start=start, end=end, outer_diameter=size, dn=dn, sigma_position=(0.3, 0.5, 0.3), sigma_direction_deg=0.05)
        for row, ((start, end), (size, dn)) in enumerate(zip(ENDS, SIZES, strict=True))
    )
    return Pipeline.of_station("A", pipes)


@pytest.fixture
def file(pipeline, tmp_path):
    path = tmp_path / "built.json"
    pipeline.write(path)
    return path


def ends(path):
    return np.array([(pipe.start, pipe.end) for pipe in Pipeline.read(path).pipes])


def test_typed_placement_moves_and_turns(file, tmp_path, capsys):
    out = tmp_path / "placed.json"
    assert main(["place", str(file), "--placement", "1000", "2000", "300", "90", "--out", str(out)]) == 0
    assert "placed.json" in capsys.readouterr().out
    np.testing.assert_allclose(ends(out)[0, 0], (1000 - 3000, 2000, 300), atol=1e-6)
    assert json.loads(out.read_text(encoding="utf-8"))["georeference"]["frame"] == "A"


def test_model_as_designed_puts_what_was_built_where_it_belongs(pipeline, file, tmp_path, capsys):
    turned = np.array([[0.0, -1, 0, 50_000], [1, 0, 0, -20_000], [0, 0, 1, 1_500], [0, 0, 0, 1]])
    designed = placed(pipeline, turned)
    model, truth, out, table = (tmp_path / name for name in ("model.ifc", "truth.json", "out.json", "deviations.csv"))
    designed.write(truth)
    assert main(["convert", str(truth), "--out", str(model), "--quiet"]) == 0
    assert main(["place", str(file), "--onto", str(model), "--deviations", str(table), "--out", str(out)]) == 0
    assert "4 components" in capsys.readouterr().out
    np.testing.assert_allclose(ends(out), ends(truth), atol=0.5)
    with table.open(encoding="utf-8", newline="") as lines:
        rows = list(csv.DictReader(lines))
    assert len(rows) == 4
    assert all(float(row["distance_start_mm"]) < 0.5 for row in rows)


@pytest.mark.parametrize(
    ("more", "said"),
    [
        (["--placement", "nan", "0", "0", "0"], "--placement"),
        (["--placement", "1", "0", "0", "0", "--deviations", "a.csv"], "--deviations"),
        (["--onto", "nowhere.ifc"], "nowhere.ifc"),
    ],
)
def test_what_does_not_fit_is_refused_in_one_line(file, tmp_path, capsys, more, said):
    assert main(["place", str(file), "--out", str(tmp_path / "out.json"), *more]) == 2
    line = capsys.readouterr().err
    assert said in line
    assert line.count("\n") == 1
    assert not (tmp_path / "out.json").exists()


def test_command_line_starts_without_numpy():
    loaded = "import sys, pipeworkbench.cli; sys.exit('numpy' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", loaded], check=False).returncode == 0
