# SPDX-License-Identifier: LGPL-2.1-or-later
"""FreeCAD document objects: the App side, without Qt, so that they work with and without a window.

A script makes objects of the domain's dataclasses and reads them back; lengths are mm in the document's frame. Nothing is
recomputed, and no step of undo is opened, until the script does so:

>>> import FreeCAD  # doctest: +SKIP
>>> from pipeworkbench.features import make_pipe  # doctest: +SKIP
>>> from pipeworkbench.pipeline import Pipe  # doctest: +SKIP
>>> document = FreeCAD.newDocument()  # doctest: +SKIP
>>> pipe = make_pipe(document, Pipe(id="P1", start=(0, 0, 0), end=(0, 0, 500), outer_diameter=48.3))  # doctest: +SKIP
>>> pipe.NominalDiameter = "DN 50"  # doctest: +SKIP
>>> document.recompute()  # doctest: +SKIP

Joints are links between the objects (`connect`): what is joined to a component follows when the component is changed.
FreeCAD is imported when a function is called, not with this module.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from pipeworkbench.features.insulating import Insulated
    from pipeworkbench.insulation.planning import Plan
    from pipeworkbench.insulation.specification import Specification
    from pipeworkbench.pipeline import AnyComponent, Cap, Elbow, Flange, Pipe, Reducer, Tee
    from pipeworkbench.recon.station import Station

__all__ = [
    "apply_specification",
    "component_of",
    "connect",
    "disconnect",
    "export_insulation",
    "insulation_of",
    "make_cap",
    "make_elbow",
    "make_flange",
    "make_insulation",
    "make_pipe",
    "make_project",
    "make_reducer",
    "make_station",
    "make_tee",
    "plan_of",
    "set_component",
]


def make_project(document: Any, name: str = "", georeference: Mapping[str, Any] | None = None) -> Any:
    """Return a document's project, made where it has none.

    Parameters
    ----------
    document : FreeCAD document
    name : str
        Of the project; a new one is named after the document where it is empty.
    georeference : mapping, optional
        ``system``, ``frame`` and ``plant_from_frame`` (4 x 4, mm), as `pipeworkbench.recon.plant.placed` writes them.
    """
    from pipeworkbench.features import project

    return project.make_project(document, name, georeference)


def make_station(document: Any, station: Station) -> Any:
    """Add a station, as `pipeworkbench.recon.station.read_station` reads it, to a document and return the object.

    Raises
    ------
    InputError
        Where the document has a station of this name.
    """
    from pipeworkbench.features.document import add_station

    return add_station(document, station)


def make_pipe(document: Any, pipe: Pipe) -> Any:
    """Add a pipe to a document, into the group of the station that it names, and return the object.

    Raises
    ------
    InputError
        Where the document has a component of this id.
    """
    return _made(document, pipe)


def make_elbow(document: Any, elbow: Elbow) -> Any:
    """Add an elbow to a document and return the object; see `make_pipe`."""
    return _made(document, elbow)


def make_flange(document: Any, flange: Flange) -> Any:
    """Add a flange to a document and return the object; see `make_pipe`."""
    return _made(document, flange)


def make_tee(document: Any, tee: Tee) -> Any:
    """Add a tee to a document and return the object; see `make_pipe`."""
    return _made(document, tee)


def make_reducer(document: Any, reducer: Reducer) -> Any:
    """Add a reducer to a document and return the object; see `make_pipe`."""
    return _made(document, reducer)


def make_cap(document: Any, cap: Cap) -> Any:
    """Add a cap to a document and return the object; see `make_pipe`."""
    return _made(document, cap)


def set_component(obj: Any, component: AnyComponent) -> None:
    """Give an object another component of its kind; what is joined to it stays where it is.

    Raises
    ------
    InputError
        Where a newer version of the workbench made the object.
    """
    from pipeworkbench.features import component as components

    components.set_component(obj, component)


def component_of(obj: Any) -> AnyComponent:
    """Return an object's component: as it was measured, without its accuracy where the user changed it since.

    Raises
    ------
    InputError
        Where the object's dimensions do not belong together.
    """
    from pipeworkbench.features import component as components

    return components.component_of(obj)


def connect(obj: Any, end: int, other: Any, other_end: int) -> None:
    """Join an end of an object to one of another; ends are numbered like the ports of components, 2 is a tee's branch."""
    from pipeworkbench.features import joints

    joints.connect(obj, end, other, other_end)


def disconnect(obj: Any, end: int) -> None:
    """Open an end of an object."""
    from pipeworkbench.features import joints

    joints.disconnect(obj, end)


def make_insulation(document: Any, objects: Iterable[Any] | None = None, specification: Specification | None = None, **settings: Any) -> Any:
    """Insulate a document's components (or those among ``objects``) and return the object that stands for it.

    Parameters
    ----------
    document : FreeCAD document
    objects : iterable of document objects, optional
    specification : Specification, optional
        What is not given as a setting, and rules for some of the components.
    **settings
        Such as ``thickness=60, material="mineral wool", jacket="aluminium"``; all of them are fields of
        `pipeworkbench.features.insulation_settings.Settings`.

    Raises
    ------
    InputError
        Where there is no component, or a value does not fit.
    """
    from pipeworkbench.features import insulation

    return insulation.make_insulation(document, objects, specification, **settings)


def insulation_of(obj: Any) -> Insulated:
    """Return which components an Insulation object holds, by their ids, and the specification that it is.

    Raises
    ------
    InputError
        Where a property's value does not fit.
    """
    from pipeworkbench.features import insulation

    return insulation.insulation_of(obj)


def apply_specification(document: Any, specification: Specification) -> Any:
    """Insulate all components of a document as a specification says, and return the object that stands for it; see `make_insulation`."""
    from pipeworkbench.features import insulation

    return insulation.apply_specification(document, specification)


def plan_of(document: Any) -> Plan:
    """Return the plan of a document's insulation: all pieces, clashes, what stays bare and why.

    Raises
    ------
    InputError
        Where nothing is insulated, or components of several stations that are not merged are.
    """
    from pipeworkbench.features import insulation

    return insulation.plan_of(document)


def export_insulation(document: Any, path: Path) -> None:
    """Write a document's insulation in the format of the path's ending: cut sheets, cut lists, models; errors as of `plan_of`."""
    from pipeworkbench.features import insulation

    insulation.export_insulation(document, path)


def _made(document: Any, component: AnyComponent) -> Any:
    from pipeworkbench.errors import InputError
    from pipeworkbench.features.document import components_in, put_into_group
    from pipeworkbench.features.kinds import add_component

    if any(obj.ComponentId == component.id for obj in components_in(document)):
        raise InputError(document.Label, component.id, "the document has a component of this id already", "give it another id")
    obj = add_component(document, component)
    put_into_group(document, [obj], component.station)
    return obj
