# SPDX-License-Identifier: LGPL-2.1-or-later
"""The project in a document: a group that holds stations and components, its name and where it lies in the plant."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

import FreeCAD

from pipeworkbench.errors import InputError
from pipeworkbench.features.base import HIDDEN, READ_ONLY, Feature, Property, is_kind, refuse_newer

COLOUR_MODES = ("kind", "quality", "loa")


class ProjectFeature(Feature):
    """Proxy of a project. A document has one at most; those of older versions have none."""

    type_name = "PipeWorkbench::Project"
    properties = (
        Property("ProjectName", "App::PropertyString", "Project", "Name of the project in reports and exchange files"),
        Property("CarryJoined", "App::PropertyBool", "Project", "What is joined to a component follows when the component is changed"),
        Property("ColourMode", "App::PropertyEnumeration", "Project", "What the colours of the components say"),
        Property("PlantSystem", "App::PropertyString", "Georeference", "The plant's coordinate system; empty where it is not known", READ_ONLY),
        Property("PlantPlacement", "App::PropertyPlacement", "Georeference", "Where the first station's frame lies in the plant", READ_ONLY),
        Property("Georeference", "App::PropertyString", "Georeference", "The georeference as exchange files have it (JSON)", HIDDEN),
    )

    def __init__(self, obj: Any) -> None:
        super().__init__(obj)
        obj.CarryJoined = True

    def add_properties(self, obj: Any) -> dict[str, Any]:
        """Add what is missing, with the list of what colours may say."""
        replaced = super().add_properties(obj)
        if tuple(obj.getEnumerationsOfProperty("ColourMode") or ()) != COLOUR_MODES:
            obj.ColourMode = list(COLOUR_MODES)
        return replaced

    def execute(self, obj: Any) -> None:
        """Do nothing: a project has no shape."""


def project_of(document: Any) -> Any | None:
    """Return a document's project, None where it has none (yet)."""
    return next((obj for obj in document.Objects if is_kind(obj, ProjectFeature)), None)


def make_project(document: Any, name: str = "", georeference: Mapping[str, Any] | None = None) -> Any:
    """Return a document's project, made where there is none.

    Parameters
    ----------
    document : FreeCAD document
    name : str
        Of the project; where it is empty, a new project is named after the document.
    georeference : mapping, optional
        ``system``, ``frame`` and ``plant_from_frame`` (4 x 4, mm), as `pipeworkbench.recon.plant.placed` writes them.

    Raises
    ------
    InputError
        Where a newer version of the workbench made the document's project.
    """
    project = project_of(document)
    if project is None:
        project = document.addObject("App::DocumentObjectGroupPython", "Project")
        ProjectFeature(project)
        project.ProjectName = name or document.Label
        project.Label = "Project"
    else:
        refuse_newer(project)
        project.ProjectName = name or project.ProjectName
    if georeference is not None:
        set_georeference(project, georeference)
    return project


def set_georeference(project: Any, georeference: Mapping[str, Any]) -> None:
    """Say where a project lies in the plant (``system``, ``frame``, ``plant_from_frame``).

    Raises
    ------
    InputError
        Where something is missing or the matrix is no 4 x 4 one.
    """
    try:
        rows = [[float(value) for value in row] for row in georeference["plant_from_frame"]]
        system, _ = str(georeference["system"]), str(georeference["frame"])
    except (KeyError, TypeError, ValueError) as error:
        raise InputError(project.Label, "georeference", f"does not fit ({error})", "give system, frame and plant_from_frame") from None
    if len(rows) != 4 or any(len(row) != 4 for row in rows):
        raise InputError(project.Label, "georeference.plant_from_frame", "is no 4 x 4 matrix", "give 4 rows of 4 numbers")
    project.PlantSystem = system
    project.PlantPlacement = FreeCAD.Placement(FreeCAD.Matrix(*(value for row in rows for value in row)))
    project.Georeference = json.dumps(dict(georeference))


def georeference_of(document: Any) -> dict[str, Any] | None:
    """Return where a document's project lies in the plant, None where it is not known."""
    project = project_of(document)
    if project is None or not project.Georeference:
        return None
    georeference: dict[str, Any] = json.loads(project.Georeference)
    return georeference


def carries_joined(document: Any) -> bool:
    """Tell whether what is joined to a component follows its changes; it does where there is no project."""
    project = project_of(document)
    return bool(getattr(project, "CarryJoined", True))
