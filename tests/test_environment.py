# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which packages are missing, and the command line that installs them."""

import shlex
import sys
from pathlib import Path

from pipeworkbench.environment import install_command, missing_packages, python_program


def test_nothing_is_missing_where_everything_is_installed():
    assert missing_packages(("cv2", "cadquery", "ifcopenshell")) == ()


def test_missing_packages_have_pips_names(monkeypatch):
    monkeypatch.setitem(sys.modules, "cv2", None)
    assert missing_packages(("cv2", "cadquery")) == ("opencv-python-headless",)
    assert missing_packages() == ()


def test_module_without_a_specification_is_there(monkeypatch):
    monkeypatch.setitem(sys.modules, "ifcopenshell", type(sys)("ifcopenshell"))
    assert missing_packages(("ifcopenshell",)) == ()


def test_command_runs_pip_of_this_python_and_leaves_numpy_alone():
    words = shlex.split(install_command(("cadquery",)))
    assert words[:5] == [sys.executable, "-m", "pip", "install", "cadquery"]
    assert words[5].startswith("numpy<")


def test_command_installs_where_freecad_looks():
    words = shlex.split(install_command(("numpy",), target=Path("/home/me/Free CAD/packages")))
    assert words[4:] == ["--target", "/home/me/Free CAD/packages", "numpy"]


def test_python_of_a_bundled_freecad_is_found_beside_it(monkeypatch, tmp_path):
    (tmp_path / "bin").mkdir()
    interpreter = tmp_path / "bin" / "python3"
    interpreter.touch()
    monkeypatch.setattr(sys, "executable", str(tmp_path / "bin" / "FreeCAD"))
    assert python_program(tmp_path) == interpreter
    assert python_program() == interpreter
    monkeypatch.setattr(sys, "executable", "/nowhere/FreeCAD")
    assert "python3" in python_program().name
