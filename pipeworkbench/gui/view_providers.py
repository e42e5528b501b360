# SPDX-License-Identifier: LGPL-2.1-or-later
"""How the document objects look in the tree and in 3D."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import FreeCAD

from pipeworkbench.errors import InputError
from pipeworkbench.features.base import Feature, is_kind
from pipeworkbench.features.cap import CapFeature
from pipeworkbench.features.carrying import together_hooks
from pipeworkbench.features.component import NONE, ComponentFeature
from pipeworkbench.features.connections import ConnectionsFeature
from pipeworkbench.features.document import components_in
from pipeworkbench.features.elbow import ElbowFeature
from pipeworkbench.features.flange import FlangeFeature
from pipeworkbench.features.insulation import InsulationFeature
from pipeworkbench.features.pipe import PipeFeature
from pipeworkbench.features.project import COLOUR_MODES, ProjectFeature, make_project, project_of
from pipeworkbench.features.reducer import ReducerFeature
from pipeworkbench.features.station import StationFeature
from pipeworkbench.features.tee import TeeFeature
from pipeworkbench.files import package_folder
from pipeworkbench.gui.colours import LegendEntry, colour_of, insulation_colour, legend_of
from pipeworkbench.gui.station_scene import StationScene

SEEN_THROUGH = 60  # per cent: insulation
# per cent of a component's size, of its triangles from it: with FreeCAD's 0.2 elbows are finer than their pipes, and are drawn slowly
DEVIATION = 1.0
COLOURED_BY = frozenset({"Quality", "LevelOfAccuracy", "Approximate"})  # properties that colours depend on


class ViewProvider:
    """A view provider with an icon; the shape is shown by FreeCAD itself."""

    icon = ""

    def __init__(self, view_object: Any) -> None:
        view_object.Proxy = self

    def getIcon(self) -> str:  # FreeCAD's name
        """Return the icon's file."""
        return str(package_folder("resources") / "icons" / self.icon)

    def dumps(self) -> None:
        """There is nothing to save."""

    def loads(self, state: object) -> None:
        """There is nothing to restore."""

    # FreeCAD 0.20 asks with these names
    __getstate__ = dumps
    __setstate__ = loads


class ComponentView(ViewProvider):
    """A component: its colour follows what it says."""

    def updateData(self, obj: Any, name: str) -> None:  # FreeCAD's name
        """Give the component its colour when what the colour says has changed."""
        if name in COLOURED_BY and isinstance(getattr(obj, "Proxy", None), ComponentFeature) and obj.ViewObject is not None:
            _colour(obj, colour_mode(obj.Document))


class PipeView(ComponentView):
    """A pipe in the tree."""

    icon = "pipe.svg"


class ElbowView(ComponentView):
    """An elbow in the tree."""

    icon = "elbow.svg"


class FlangeView(ComponentView):
    """A flange in the tree."""

    icon = "flange.svg"


class TeeView(ComponentView):
    """A tee in the tree."""

    icon = "tee.svg"


class ReducerView(ComponentView):
    """A reducer in the tree."""

    icon = "reducer.svg"


class CapView(ComponentView):
    """A cap in the tree."""

    icon = "cap.svg"


class InsulationView(ViewProvider):
    """Insulation in the tree; the pipe is seen through it, and its colour says what is outside."""

    icon = "insulation.svg"

    def updateData(self, obj: Any, name: str) -> None:  # FreeCAD's name
        """Take the colour of another jacket or material."""
        if name in ("Jacket", "Material") and obj.ViewObject is not None:
            _colour_insulation(obj)

    def doubleClicked(self, view_object: Any) -> bool:  # FreeCAD's name
        """Open the panel with the object's settings."""
        from pipeworkbench.gui.failures import failures_told

        with failures_told(view_object.Object.Label):
            from pipeworkbench.gui.pipeline_panels.insulation import InsulationPanel

            InsulationPanel(view_object.Object.Document, view_object.Object).open()
        return True


class ConnectionsView(ViewProvider):
    """What is known beyond the components in the tree."""

    icon = "connections.svg"


class ProjectView(ViewProvider):
    """A project in the tree; what its colours say can be changed there too."""

    icon = "project.svg"

    def updateData(self, obj: Any, name: str) -> None:  # FreeCAD's name
        """Colour all components anew when the user chooses what colours say."""
        if name == "ColourMode" and obj.ColourMode in COLOUR_MODES:
            for component in components_in(obj.Document):
                _colour(component, obj.ColourMode)


class StationView(ViewProvider):
    """A station in the tree, its cameras and, on request, a photograph in 3D."""

    icon = "station.svg"
    scene: StationScene | None = None

    def attach(self, view_object: Any) -> None:  # FreeCAD's name
        """Put the cameras into the 3D view."""
        self.scene = StationScene.attached_to(view_object)

    def updateData(self, obj: Any, name: str) -> None:  # FreeCAD's name
        """Let the cameras follow the station."""
        if self.scene is not None:
            self.scene.object_changed(obj, name)

    def onChanged(self, view_object: Any, name: str) -> None:  # FreeCAD's name
        """Let the cameras follow the view's properties."""
        if self.scene is not None:
            self.scene.view_changed(view_object, name)

    def doubleClicked(self, view_object: Any) -> bool:  # FreeCAD's name
        """Show the station's photographs."""
        from pipeworkbench.gui.failures import failures_told

        with failures_told(view_object.Object.Label):
            from pipeworkbench.gui.photos.windows import open_photo_window

            open_photo_window(view_object.Object)
        return True

    def setupContextMenu(self, view_object: Any, menu: Any) -> None:  # FreeCAD's name
        """Offer what is done with a station's photographs."""
        from pipeworkbench.gui.station_menu import fill

        fill(menu, view_object.Object)

    def onDelete(self, view_object: Any, subelements: object) -> bool:  # noqa: ARG002  # FreeCAD's name
        """Delete the station alone: what was measured from it goes to the project."""
        station = view_object.Object
        project, measured = project_of(station.Document), list(station.Group)
        for obj in measured:
            if project is not None:
                project.addObject(obj)
        if measured:
            FreeCAD.Console.PrintMessage(f"{station.Label} is deleted; the {len(measured)} objects measured from it stay\n")
        return True


VIEWS: dict[type[Feature], type[ViewProvider]] = {
    ProjectFeature: ProjectView,
    PipeFeature: PipeView,
    ElbowFeature: ElbowView,
    FlangeFeature: FlangeView,
    TeeFeature: TeeView,
    ReducerFeature: ReducerView,
    CapFeature: CapView,
    ConnectionsFeature: ConnectionsView,
    InsulationFeature: InsulationView,
    StationFeature: StationView,
}


def show(obj: Any) -> None:
    """Give a document object its view provider, and its colour where it has none yet."""
    view = next((view for feature, view in VIEWS.items() if is_kind(obj, feature)), None)
    if view is None or obj.ViewObject is None or isinstance(obj.ViewObject.Proxy, view):
        return
    view(obj.ViewObject)
    # FreeCAD hides what was written without a window
    obj.ViewObject.Visibility = True
    if isinstance(obj.Proxy, ComponentFeature):
        obj.ViewObject.Deviation = DEVIATION
        _colour(obj, colour_mode(obj.Document))
    elif is_kind(obj, InsulationFeature):
        obj.ViewObject.Transparency = SEEN_THROUGH
        _colour_insulation(obj)


def colour_mode(document: Any) -> str:
    """Return what the colours of a document's components say: "kind", "quality" or "loa"."""
    mode = getattr(project_of(document), "ColourMode", COLOUR_MODES[0])
    return mode if mode in COLOUR_MODES else COLOUR_MODES[0]


def colour_by(document: Any, mode: str) -> list[LegendEntry]:
    """Colour a document's components by kind, quality or level of accuracy, which its project remembers; return the legend.

    Parameters
    ----------
    document : FreeCAD document
    mode : str
        "kind", "quality" or "loa".

    Raises
    ------
    InputError
        Where there is no such mode.
    """
    if mode not in COLOUR_MODES:
        raise InputError(document.Label, "colours", f"cannot say '{mode}'", f"choose one of {', '.join(COLOUR_MODES)}")
    project = project_of(document) or make_project(document)
    if project.ColourMode != mode:
        project.ColourMode = mode  # the project's view colours them
    else:
        recolour(document)
    return legend_of(mode)


def recolour(document: Any) -> None:
    """Give all components of a document the colours that the user has set."""
    mode = colour_mode(document)
    for obj in components_in(document):
        _colour(obj, mode)


def select(document: Any, names: Iterable[str], *, add: bool = False) -> None:
    """Select a document's objects by their names, in addition to what is selected or instead of it."""
    import FreeCADGui

    if not add:
        FreeCADGui.Selection.clearSelection()
    for name in names:
        if document.getObject(name) is not None:
            FreeCADGui.Selection.addSelection(document.Name, name)


def _selected_with(obj: Any) -> set[str]:
    """Return what is selected together with an object, by name: a command that moves one of them moves all."""
    if not FreeCAD.GuiUp:
        return set()
    import FreeCADGui

    names = {other.Name for other in FreeCADGui.Selection.getSelection(obj.Document.Name)}
    return names if obj.Name in names else set()


together_hooks.append(_selected_with)


def _colour(obj: Any, mode: str) -> None:
    colour = colour_of(obj, mode)
    if obj.ViewObject is not None and obj.ViewObject.ShapeColor[:3] != colour:
        obj.ViewObject.ShapeColor = colour


def _colour_insulation(obj: Any) -> None:
    obj.ViewObject.ShapeColor = insulation_colour(getattr(obj, "Jacket", NONE), getattr(obj, "Material", ""))
