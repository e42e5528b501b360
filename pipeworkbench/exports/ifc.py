# SPDX-License-Identifier: LGPL-2.1-or-later
"""IFC: pipes as IfcPipeSegment, everything else as IfcPipeFitting, in millimetres; IFC4 (Reference View) or IFC 4.3.

IFC names what a fitting does, not what it is: an elbow is a BEND, a tee a JUNCTION, a reducer a TRANSITION. A flange is a CONNECTOR, which
joins two pipes (the enumeration has no flange), with the ElementType FLANGE; a cap and a blind flange, which close a pipe's end, are an
OBSTRUCTION. That stands on types, one for each distinct dimension, with the body that their fittings share; a pipe has its own length and
therefore its own body. Ports are nested in the components and connected at every joint; components between open ends and branches are a
system.

GlobalIds derive from the project and the components' ids, and everything is written in the pipeline's order: the same pipeline with the same
timestamp gives the same file, byte by byte, and a pipe that was moved changes nothing but what is its own and the ports joined to it.
"""

from __future__ import annotations

import os
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from pipeworkbench.catalogue import pipe_size
from pipeworkbench.errors import InputError
from pipeworkbench.exports.ifc_coverings import Coverings, Planned, planned_coverings
from pipeworkbench.exports.ifc_file import Entities, digest, finite, label
from pipeworkbench.exports.ifc_network import SINK, SOURCE, Network, connection_type, network_of
from pipeworkbench.exports.ifc_properties import AS_BUILT, Properties, Quantities, as_built_properties, port_properties, quantities, shared_sets
from pipeworkbench.exports.ifc_shapes import Shapes
from pipeworkbench.exports.ifc_spatial import Spatial, on_map, project_key, skeleton
from pipeworkbench.exports.ifc_types import Types
from pipeworkbench.exports.ifc_update import carry_over
from pipeworkbench.files import written_whole
from pipeworkbench.pipeline import AnyComponent, Flange, Pipe, Pipeline, Port, Tee
from pipeworkbench.recon.topology import runs_of
from pipeworkbench.solids import Frame, frame_of

if TYPE_CHECKING:
    import ifcopenshell

    from pipeworkbench.insulation.planning import Plan

Schema = Literal["IFC4", "IFC4X3_ADD2"]
SCHEMAS: tuple[Schema, ...] = ("IFC4", "IFC4X3_ADD2")
SHORTEST_MM = 0.001  # of what can be written: IFC wants positive lengths
SYSTEM = "system"  # what a component's extra calls the user's name of its run
PORT_NAMES = ("start", "end", "branch")
FLANGE_PORT_NAMES = ("face", "weld end")


@dataclass(frozen=True)
class IfcOptions:
    """How to write IFC: its schema, and the time that the file says it was written (seconds since 1970, UTC; now where it is not given).

    The environment's ``SOURCE_DATE_EPOCH`` stands for now where it is set, as reproducible builds have it. With a ``plan`` of the
    pipeline's insulation that is written; without one what components say of theirs (``extra["insulation"]``).
    """

    schema: Schema = "IFC4"
    timestamp: int | None = None
    plan: Plan | None = None

    @property
    def seconds(self) -> int:
        """The time of writing, seconds since 1970."""
        if self.timestamp is not None:
            return self.timestamp
        given = os.environ.get("SOURCE_DATE_EPOCH", "")
        return int(given) if given.isdecimal() else int(time.time())


def write_ifc(pipeline: Pipeline, path: Path, options: IfcOptions | None = None) -> None:
    """Write an IFC file, whole or not at all.

    Where the file is there already and holds the same project, what others added to it stays with the components that are still there:
    property sets, classifications, documents and groups.

    Raises
    ------
    InputError
        Where a component cannot be written, two have the same id, a joint does not fit, or the file cannot be written.
    MissingPackageError
        Where ifcopenshell is not installed.
    """
    file = ifc_model(pipeline, path.name, options)
    carry_over(path, file)
    text = file.to_string().encode("utf-8")
    # written by Python, which says when the disk is full
    with written_whole(path) as temporary:
        temporary.write_bytes(text)


def ifc_model(pipeline: Pipeline, name: str = "pipeline.ifc", options: IfcOptions | None = None) -> ifcopenshell.file:
    """Return the pipeline as an ifcopenshell model; errors are those of `write_ifc`."""
    options = options or IfcOptions()
    if options.schema not in SCHEMAS:
        raise InputError(name, "schema", f"is {options.schema!r}", f"use one of {', '.join(SCHEMAS)}")
    _refuse(pipeline)
    project, (local, place) = project_key(pipeline), on_map(pipeline)
    entities = Entities(options.schema, project, options.seconds, name)
    title = pipeline.extra.get("project")
    spatial = skeleton(entities, title if isinstance(title, str) and title else project, place)
    _Plant(entities, spatial, local, planned_coverings(options.plan, place)).write()
    return entities.file


class _Plant:
    """Writes a pipeline's components and what belongs to them into a file that has its skeleton."""

    def __init__(self, entities: Entities, spatial: Spatial, pipeline: Pipeline, planned: Planned | None) -> None:
        self.entities, self.spatial, self.pipeline = entities, spatial, pipeline
        self.shapes = Shapes(entities)
        self.types = Types(entities, self.shapes, spatial.body)
        self.coverings = Coverings(entities, self.shapes, self.types, planned)
        self.network: Network = network_of(pipeline.components, pipeline.joints, pipeline.frame)
        self.ports: dict[tuple[str, int], Any] = {}
        self.described: dict[tuple[str, str], tuple[Any, list[Any]]] = {}  # property and quantity sets that several things share
        said = pipeline.extra.get("date")
        self.date = said if isinstance(said, str) else entities.file.header.file_name.time_stamp[:10]

    def write(self) -> None:
        """Write everything, in the pipeline's order."""
        products = {component.id: self.component(component) for component in self.pipeline.components}
        self.types.relate()
        for key, (described, things) in self.described.items():
            many = {"RelatingPropertyDefinition": described, "RelatedObjects": tuple(things)}
            self.entities.root("IfcRelDefinesByProperties", "/".join(key), **many)
        self.joints()
        self.systems(products)
        if products:
            self.entities.relate(
                "IfcRelContainedInSpatialStructure", "contained", "RelatingStructure", "RelatedElements", self.spatial.storey, list(products.values())
            )

    def component(self, component: AnyComponent) -> Any:
        """Add a component with its place, body, ports and what is known of it."""
        self.entities.begin_component()
        frame = frame_of(component)
        placement = self.place(self.spatial.storey.ObjectPlacement, frame)
        typed = self.types.of(component, frame)
        product = self.entities.root(
            "IfcPipeSegment" if isinstance(component, Pipe) else "IfcPipeFitting",
            component.id,
            Name=label(_name(component)),
            ObjectPlacement=placement,
            Representation=self.representation(component, typed.mapped),
            Tag=label(component.id),
        )
        typed.occurrences.append(product)
        as_built = f"{component.id}/{AS_BUILT}"
        self.entities.describe(product, as_built, self.types.property_set(as_built, AS_BUILT, as_built_properties(component, self.date)))
        for name, properties in shared_sets(component, self.entities.schema).items():
            self.share(product, name, properties)
        name, found = quantities(component)
        if isinstance(component, Pipe):
            self.entities.describe(product, f"{component.id}/{name}", self.entities.quantity_set(f"{component.id}/{name}", name, found))
        else:
            self.share_quantities(product, typed.key, name, found)
        self.nest_ports(component, product, frame)
        self.coverings.of(component, product, frame, _name(component))
        return product

    def place(self, parent: Any, frame: Frame) -> Any:
        """Return a frame as a placement relative to another."""
        axes = self.entities.axes(frame.origin.tolist(), frame.z.tolist(), frame.x.tolist())
        return self.entities.add("IfcLocalPlacement", PlacementRelTo=parent, RelativePlacement=axes)

    def representation(self, component: AnyComponent, mapped: Any | None) -> Any:
        """Return a component's shapes: a pipe's axis and its own body, a fitting's body as its type has it."""
        add = self.entities.add
        if mapped is not None:
            item = add("IfcMappedItem", MappingSource=mapped, MappingTarget=self.types.as_it_is)
            shapes = [self.types.shape("MappedRepresentation", [item])]
        else:
            axis = {"RepresentationIdentifier": "Axis", "RepresentationType": "Curve3D", "Items": (self.shapes.line(component.length),)}
            body = self.types.styled(self.shapes.body(component, frame_of(component)), type(component))
            shapes = [add("IfcShapeRepresentation", ContextOfItems=self.spatial.axis, **axis), self.types.shape(*body)]
        return add("IfcProductDefinitionShape", Representations=tuple(shapes))

    def share(self, thing: Any, name: str, properties: Properties) -> None:
        """Describe a thing with a property set that it has in common with others."""
        key = name, digest(properties)
        if key not in self.described:
            self.described[key] = self.types.shared_set(name, properties), []
        self.described[key][1].append(thing)

    def share_quantities(self, thing: Any, key: str, name: str, found: Quantities) -> None:
        """Describe a fitting with the quantities of its type."""
        if (name, key) not in self.described:
            self.described[name, key] = self.entities.quantity_set(f"{name}/{key}", name, found), []
        self.described[name, key][1].append(thing)

    def nest_ports(self, component: AnyComponent, product: Any, frame: Frame) -> None:
        """Add a component's ports: where its joints are, their z axes along the flow."""
        names = FLANGE_PORT_NAMES if isinstance(component, Flange) else PORT_NAMES
        turn, made = np.array([frame.x, frame.y, frame.z]), []
        for number, port in enumerate(component.ports):
            end = component.id, number
            place, flow = self.network.places[end], self.network.flow[end]
            along = turn @ np.array(port.direction) * (1.0 if flow == SOURCE else -1.0)
            axes = self._port_axes(turn @ (np.array(place) - frame.origin), along)
            made.append(
                self.entities.root(
                    "IfcDistributionPort",
                    f"{component.id}/{number}",
                    Name=names[number],
                    ObjectPlacement=self.entities.add("IfcLocalPlacement", PlacementRelTo=product.ObjectPlacement, RelativePlacement=axes),
                    FlowDirection=flow,
                    PredefinedType="PIPE",
                    SystemType="NOTDEFINED",
                )
            )
            self.ports[end] = made[-1]
            connection = connection_type(component, number, joined=end in self.network.partners)
            self.share(made[-1], "Pset_DistributionPortTypePipe", port_properties(connection, *_size(component, port)))
        self.entities.relate("IfcRelNests", component.id, "RelatingObject", "RelatedObjects", product, made)

    def joints(self) -> None:
        """Connect the ports of every joint, from where it flows out to where it flows in."""
        for joint in self.pipeline.joints:
            ends = sorted([(joint.a, int(joint.a_port)), (joint.b, int(joint.b_port))])
            source, sink = sorted(ends, key=lambda end: self.network.flow[end] == SINK)
            self.entities.root("IfcRelConnectsPorts", repr(ends), RelatingPort=self.ports[source], RelatedPort=self.ports[sink])

    def systems(self, products: dict[str, Any]) -> None:
        """Group what follows each other between open ends and branches; a tee belongs to the run at its own run's start."""
        members: dict[str, list[str]] = {}
        titles: dict[str, str] = {}
        of: dict[str, str] = {}
        by_id = {component.id: component for component in self.pipeline.components}
        runs = runs_of(self.pipeline.components, self.pipeline.joints)
        order = {component.id: index for index, component in enumerate(self.pipeline.components)}
        for run in sorted((sorted(run, key=order.__getitem__) for run in runs), key=lambda run: order[run[0]]):
            self._join(members, titles, of, run, by_id)
        for tee in (component for component in self.pipeline.components if isinstance(component, Tee)):
            partners = [self.network.partners.get((tee.id, port)) for port in range(3)]
            key = next((of[end[0]] for end in partners if end is not None and end[0] in of), None)
            if key is None or tee.extra.get(SYSTEM):
                self._join(members, titles, of, [tee.id], by_id)
            else:
                of[tee.id] = key
                members[key].append(tee.id)
        made = []
        for key, ids in members.items():
            system = self.entities.root("IfcDistributionSystem", key, Name=label(titles[key]), PredefinedType="NOTDEFINED")
            inside = [products[name] for name in sorted(ids, key=order.__getitem__)]
            self.entities.relate("IfcRelAssignsToGroup", key, "RelatingGroup", "RelatedObjects", system, inside)
            made.append(system)
        if made and self.entities.schema == "IFC4":
            for key, system in zip(members, made, strict=True):
                self.entities.relate("IfcRelServicesBuildings", key, "RelatingSystem", "RelatedBuildings", system, [self.spatial.building])
        elif made:
            # IFC 4.3 has deprecated the other relation
            kind = "IfcRelReferencedInSpatialStructure"
            self.entities.relate(kind, "systems", "RelatingStructure", "RelatedElements", self.spatial.building, made)

    def _join(
        self, members: dict[str, list[str]], titles: dict[str, str], of: dict[str, str], run: Sequence[str], by_id: dict[str, AnyComponent]
    ) -> None:
        """Put a run into the system of its name, or into one of its own."""
        named = next((name for one in run if isinstance(name := by_id[one].extra.get(SYSTEM), str) and name), None)
        key = f"named/{named}" if named else f"of/{run[0]}"
        titles.setdefault(key, named or f"Run {run[0]}")
        members.setdefault(key, []).extend(run)
        of.update(dict.fromkeys(run, key))

    def _port_axes(self, place: Any, along: Any) -> Any:
        """Return a port's axes: z along the flow, x across it."""
        x = (1.0, 0.0, 0.0) if abs(along[0]) < 0.7 else (0.0, 1.0, 0.0)
        across = np.array(x) - (np.array(x) @ along) * along
        return self.entities.axes(place, along.tolist(), (across / np.linalg.norm(across)).tolist())


def _name(component: AnyComponent) -> str:
    """Return what people call a component: a name that it was given, else its id."""
    said = component.extra.get("name")
    return said if isinstance(said, str) and said else component.id


def _size(component: AnyComponent, port: Port) -> tuple[int | None, float]:
    """Return a port's nominal and outside diameter (mm): the component's, or what the catalogue has for a branch or a narrow end."""
    if isinstance(component, Flange) or port.diameter == component.outer_diameter:
        return component.dn, component.outer_diameter
    size = pipe_size(port.diameter)
    return (size.dn if size else None), port.diameter


def _refuse(pipeline: Pipeline) -> None:
    """Refuse what would make a broken file, for scripts that put a pipeline together themselves."""
    seen: set[str] = set()
    for index, component in enumerate(pipeline.components):
        if component.id in seen:
            raise InputError(pipeline.frame, f"components[{index}].id", f"'{component.id}' is used twice", "give each component its own id")
        seen.add(component.id)
        finite(component.id, [value for port in component.ports for value in (*port.point, *port.direction, port.diameter)])
        if not component.length >= SHORTEST_MM:
            raise InputError(component.id, "length", f"is {component.length:g} mm", "leave the component out or correct its points")
