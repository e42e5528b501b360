# SPDX-License-Identifier: LGPL-2.1-or-later
"""How the document objects look in the tree and in 3D."""

from __future__ import annotations

from typing import Any

from pipeworkbench.exports.kinds import COLOURS
from pipeworkbench.features.base import Feature, is_kind
from pipeworkbench.features.cap import CapFeature
from pipeworkbench.features.component import ComponentFeature
from pipeworkbench.features.connections import ConnectionsFeature
from pipeworkbench.features.elbow import ElbowFeature
from pipeworkbench.features.flange import FlangeFeature
from pipeworkbench.features.pipe import PipeFeature
from pipeworkbench.features.reducer import ReducerFeature
from pipeworkbench.features.station import StationFeature
from pipeworkbench.features.tee import TeeFeature
from pipeworkbench.files import package_folder

APPROXIMATE_COLOUR = (0.90, 0.62, 0.0)


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


class PipeView(ViewProvider):
    """A pipe in the tree."""

    icon = "pipe.svg"


class ElbowView(ViewProvider):
    """An elbow in the tree."""

    icon = "elbow.svg"


class FlangeView(ViewProvider):
    """A flange in the tree."""

    icon = "flange.svg"


class TeeView(ViewProvider):
    """A tee in the tree."""

    icon = "tee.svg"


class ReducerView(ViewProvider):
    """A reducer in the tree."""

    icon = "reducer.svg"


class CapView(ViewProvider):
    """A cap in the tree."""

    icon = "cap.svg"


class ConnectionsView(ViewProvider):
    """Joints and stations in the tree."""

    icon = "connections.svg"


class StationView(ViewProvider):
    """A station in the tree."""

    icon = "station.svg"


VIEWS: dict[type[Feature], type[ViewProvider]] = {
    PipeFeature: PipeView,
    ElbowFeature: ElbowView,
    FlangeFeature: FlangeView,
    TeeFeature: TeeView,
    ReducerFeature: ReducerView,
    CapFeature: CapView,
    ConnectionsFeature: ConnectionsView,
    StationFeature: StationView,
}


def show(obj: Any) -> None:
    """Give a document object its view provider and colour."""
    view = next((view for feature, view in VIEWS.items() if is_kind(obj, feature)), None)
    if view is None or obj.ViewObject is None:
        return
    if not isinstance(obj.ViewObject.Proxy, view):
        view(obj.ViewObject)
        # FreeCAD hides what was written without a window
        obj.ViewObject.Visibility = True
    if isinstance(obj.Proxy, ComponentFeature):
        obj.ViewObject.ShapeColor = APPROXIMATE_COLOUR if getattr(obj, "Approximate", False) else COLOURS[obj.Proxy.kind]
