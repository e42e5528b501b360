# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where FreeCAD's own Python finds this program's packages, and which of them are missing."""

from __future__ import annotations

import importlib.util
import os
import sys
from pathlib import Path

REQUIRED = {
    "numpy": "numpy",
    "scipy": "scipy",
    "cv2": "opencv-python-headless",
    "pydantic": "pydantic",
    "annotated_types": "annotated-types",
    "rich": "rich",
    "cadquery": "cadquery",
    "ifcopenshell": "ifcopenshell",
}


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


def missing_packages() -> tuple[str, ...]:
    """Return the names, as pip knows them, of the required packages that cannot be imported."""
    return tuple(package for module, package in REQUIRED.items() if importlib.util.find_spec(module) is None)
