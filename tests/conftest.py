# SPDX-License-Identifier: LGPL-2.1-or-later
"""Fixtures that all tests share: the bundled sample, the scenes with known truth, altered stations."""

import json
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from hypothesis import settings

from pipeworkbench.pipeline import Pipeline

ROOT = Path(__file__).resolve().parent.parent
Change = Callable[[dict[str, Any]], object]

# geometry is checked with the same examples on every machine, however slow it is
settings.register_profile("repeatable", deadline=None, derandomize=True, database=None)
settings.load_profile("repeatable")


@pytest.fixture(scope="session")
def sample() -> Path:
    """The bundled sample station."""
    return ROOT / "resources" / "samples" / "dummy" / "A"


@pytest.fixture(scope="session")
def shared() -> Path:
    """The folder beside the repository with scenes of known truth and sourced standards."""
    folder = ROOT.parent / "shared"
    if not folder.is_dir():
        pytest.skip("the folder 'shared' with scenes and standards is not beside the repository")
    return folder


@pytest.fixture(scope="session")
def everything() -> Pipeline:
    """A pipeline with one of every kind of component, joined."""
    return Pipeline.read(ROOT / "tests" / "data" / "one_of_everything.json")


def link_or_copy(source: Path, target: Path) -> None:
    """Put a large file somewhere else without copying it where links can be made."""
    try:
        target.symlink_to(source)
    except OSError:
        shutil.copy(source, target)


def altered_station(sample: Path, folder: Path, station: Change | None = None, picks: Change | None = None) -> Path:
    """Write the sample into a folder with its JSON changed in place by the given functions."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, change in (("station.json", station), ("picks.json", picks)):
        data = json.loads((sample / name).read_text(encoding="utf-8"))
        if change is not None:
            change(data)
        (folder / name).write_text(json.dumps(data), encoding="utf-8")
    for image in sample.glob("*.jpg"):
        link_or_copy(image, folder / image.name)
    return folder


@pytest.fixture
def altered(sample, tmp_path):
    """Give a function that writes a changed copy of the sample station and returns its folder."""

    def alter(station: Change | None = None, picks: Change | None = None) -> Path:
        return altered_station(sample, tmp_path / "station", station, picks)

    return alter
