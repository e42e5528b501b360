# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where FreeCAD's own Python finds this program's packages, and which of them are missing."""

from __future__ import annotations

import importlib.util
import os
import sys
from collections.abc import Iterable
from pathlib import Path

# what can be imported, and what pip knows it as
PACKAGES = {
    "numpy": "numpy",
    "scipy": "scipy",
    "cv2": "opencv-python-headless",
    "pydantic": "pydantic",
    "annotated_types": "annotated-types",
    "yaml": "pyyaml",
    "cadquery": "cadquery",
    "ifcopenshell": "ifcopenshell",
    "jinja2": "jinja2",
    "matplotlib": "matplotlib",
}
ALWAYS_NEEDED = ("numpy", "scipy", "pydantic", "annotated_types")  # whatever is done with stations and components
PYTHON_NAMES = ("python3", "python", "python.exe")


def site_packages(environment: Path) -> Path | None:
    """Return the site-packages of a virtual environment made for this Python, None where it is not."""
    version = f"python{sys.version_info.major}.{sys.version_info.minor}"
    candidates = (environment / "Lib",) if os.name == "nt" else (environment / "lib" / version,)
    for candidate in candidates:
        if (candidate / "site-packages").is_dir():
            return candidate / "site-packages"
    return None


def use_environment(root: Path) -> bool:
    """Put the packages of ``root``/.venv on the path, before the system's; True where there are any.

    An environment of another Python version is left alone: its compiled packages would not load.
    """
    folder = site_packages(root / ".venv")
    if folder is None:
        return False
    if str(folder) not in sys.path:
        sys.path.insert(0, str(folder))
    return True


def missing_packages(modules: Iterable[str] = ()) -> tuple[str, ...]:
    """Return the names, as pip knows them, of the modules that cannot be imported, of those that everything needs and of ``modules``."""
    wanted = dict.fromkeys((*ALWAYS_NEEDED, *modules))
    return tuple(PACKAGES.get(module, module) for module in wanted if not _can_be_imported(module))


def install_command(packages: Iterable[str], home: Path | None = None, target: Path | None = None) -> str:
    """Return the command line that installs packages for this Python, as the system's shell takes it.

    Parameters
    ----------
    packages : iterable of str
        As pip knows them.
    home : Path, optional
        FreeCAD's program folder, whose Python is used where it has one of its own.
    target : Path, optional
        The folder of packages that FreeCAD reads; without one they go where pip puts them.
    """
    # late: reading these takes longer than the rest of FreeCAD's start-up does
    import shlex
    import subprocess

    wanted = [*packages]
    numpy = _major_version("numpy")
    if numpy is not None and "numpy" not in wanted:
        # a newer NumPy beside the program's own would break what was built for that one
        wanted.append(f"numpy<{numpy + 1}")
    words = [str(python_program(home)), "-m", "pip", "install", *(("--target", str(target)) if target else ()), *wanted]
    return subprocess.list2cmdline(words) if os.name == "nt" else shlex.join(words)


def python_program(home: Path | None = None) -> Path:
    """Return the interpreter that pip must run with: inside FreeCAD ``sys.executable`` is FreeCAD itself."""
    import shutil

    version = f"python{sys.version_info.major}.{sys.version_info.minor}"
    running = Path(sys.executable or "")
    if running.stem.lower().startswith("python"):
        return running
    folders = () if home is None else (home / "bin", home, home.parent / "bin")
    beside = [folder / name for folder in (*folders, running.parent) for name in (version, *PYTHON_NAMES)]
    found = next((path for path in beside if path.is_file()), None)
    return found or Path(shutil.which(version) or version)


def _can_be_imported(module: str) -> bool:
    try:
        return importlib.util.find_spec(module) is not None
    except ValueError:  # loaded already, but not from a file
        return True


def _major_version(package: str) -> int | None:
    import importlib.metadata

    try:
        return int(importlib.metadata.version(package).split(".")[0])
    except (importlib.metadata.PackageNotFoundError, ValueError):
        return None
