# SPDX-License-Identifier: LGPL-2.1-or-later
"""What an IFC file of a pipeline must be, as checks that know nothing of the writer: each returns what is wrong, in sentences."""

import io
import json
import math
import os
import shutil
import subprocess
import sys
from collections import Counter, defaultdict
from dataclasses import dataclass
from pathlib import Path

import ifcopenshell
import ifcopenshell.geom
import numpy as np
from ifcopenshell import ifcopenshell_wrapper
from ifcopenshell.util.element import get_predefined_type, get_type
from ifcopenshell.util.placement import get_local_placement
from ifcopenshell.util.pset import get_template

from pipeworkbench.pipeline import Cap, Elbow, Flange, Pipe, Reducer, Tee
from pipeworkbench.recon.topology import runs_of
from pipeworkbench.solids import component_solid
from pipeworkbench.solids.outlines import flange_outline, reducer_outline

ROOT = Path(__file__).resolve().parents[2]
COINCIDENT_MM = 0.01
TURNED_DEG = 1e-3  # of axes that ought to be parallel, where the pipeline's own are
JOINT_SLACK_MM = 1e-3
PREDEFINED = {Elbow: "BEND", Tee: "JUNCTION", Reducer: "TRANSITION", Cap: "OBSTRUCTION"}
COMPONENTS = ("IfcPipeSegment", "IfcPipeFitting")
READER = ROOT / "scripts" / "web_ifc" / "read.cjs"


def products_by_tag(model, kinds=COMPONENTS):
    """Return the products of some kinds of a model by their Tags, which are the components' ids; they live as long as the model."""
    found = [item for kind in kinds for item in model.by_type(kind)]
    by_tag = {item.Tag: item for item in found}
    assert len(by_tag) == len(found), f"Tags are used twice: {[tag for tag, number in Counter(i.Tag for i in found).items() if number > 1]}"
    return by_tag


# ---------------------------------------------------------------- the file as a whole


def command_faults(path, *, rules=True):
    """Return what ifcopenshell's own commands find, run as a coordinator runs them; the validator's rules take pytest."""
    faults = []
    for command in (["ifcopenshell.validate", *(["--rules"] if rules else []), "--json"], ["ifcopenshell.simple_spf", "--json"]):
        done = subprocess.run([sys.executable, "-m", *command, str(path)], capture_output=True, text=True, check=False)  # our own interpreter
        said = done.stdout.strip()
        if done.returncode or (said and any(json.loads(line) for line in said.splitlines() if line.startswith(("[", "{")))):
            faults.append(f"{command[0]} exits with {done.returncode}: {(said + done.stderr)[:2000]}")
    return faults


def header_faults(model, schema):
    """Return what is wrong with the header, units and contexts."""
    faults = []
    description, name = model.header.file_description, model.header.file_name
    if model.schema_identifier != schema:
        faults.append(f"schema is {model.schema_identifier}, not {schema}")
    if "ViewDefinition [ReferenceView_V1.2]" not in description.description and schema == "IFC4":
        faults.append(f"view definition is {description.description}")
    if len(parts := name.originating_system.split(" - ")) != 3 or not all(parts):
        faults.append(f"originating system '{name.originating_system}' is not 'Company - App - version'")
    units = {unit.UnitType: unit for unit in model.by_type("IfcProject")[0].UnitsInContext.Units if unit.is_a("IfcSIUnit")}
    if (units["LENGTHUNIT"].Prefix, units["PLANEANGLEUNIT"].Name) != ("MILLI", "RADIAN"):
        faults.append("units are not mm and RADIAN")
    contexts = {(c.ContextType, c.ContextIdentifier) for c in model.by_type("IfcGeometricRepresentationSubContext")}
    if not {("Model", "Body"), ("Model", "Axis")} <= contexts:
        faults.append(f"contexts are {contexts}")
    faults += [f"{len(model.by_type(kind))} of {kind}" for kind in ("IfcProject", "IfcSite", "IfcBuilding") if len(model.by_type(kind)) != 1]
    for history in model.by_type("IfcOwnerHistory"):
        if history.ChangeAction not in {"ADDED", "NOCHANGE", "MODIFIED"} or history.LastModifiedDate is None:
            faults.append(f"owner history #{history.id()} lacks ChangeAction or LastModifiedDate")
    ids = Counter(item.GlobalId for item in model.by_type("IfcRoot"))
    return faults + [f"GlobalId {key} is used {number} times" for key, number in ids.items() if number > 1]


def type_faults(model, pipeline):
    """Return what is wrong with types, predefined types and containment of a pipeline's components."""
    faults = []
    products = products_by_tag(model)
    wanted = {component.id: component for component in pipeline.components}
    if set(products) != set(wanted):
        return [f"missing: {sorted(set(wanted) - set(products))}; too many: {sorted(set(products) - set(wanted))}"]
    for key, component in wanted.items():
        product = products[key]
        kind = "IfcPipeSegment" if isinstance(component, Pipe) else "IfcPipeFitting"
        made = get_type(product)
        if product.is_a() != kind:
            faults.append(f"{key}: is {product.is_a()}")
        if made is None or made.is_a() != f"{kind}Type":
            faults.append(f"{key}: type is {made}")
            continue
        if product.PredefinedType is not None:
            faults.append(f"{key}: PredefinedType {product.PredefinedType} on the occurrence of a typed product")
        if (told := get_predefined_type(product)) != predefined(component):
            faults.append(f"{key}: predefined type is {told}, not {predefined(component)}")
        if isinstance(component, Flange) and "FLANGE" not in (made.ElementType or ""):
            faults.append(f"{key}: ElementType is {made.ElementType}")
        if not product.HasAssociations and not made.HasAssociations:
            faults.append(f"{key}: no material")
        if len(product.ContainedInStructure) != 1:
            faults.append(f"{key}: contained {len(product.ContainedInStructure)} times")
    used = Counter(get_type(product).id() for product in products.values() if get_type(product))
    types = [*model.by_type("IfcPipeSegmentType"), *model.by_type("IfcPipeFittingType")]
    faults += [f"type {item.Name} has no occurrence" for item in types if item.id() not in used]
    names = Counter((item.is_a(), item.Name) for item in types)
    return faults + [f"{number} types are called {name}" for (_, name), number in names.items() if number > 1]


def predefined(component):
    """Return the value of PredefinedType that says what a component does."""
    if isinstance(component, Pipe):
        return "RIGIDSEGMENT"
    if isinstance(component, Flange):
        return "OBSTRUCTION" if len(component.ports) == 1 else "CONNECTOR"
    return PREDEFINED[type(component)]


# ---------------------------------------------------------------- property sets


def property_set_faults(model):
    """Return the standard property sets whose names, properties, kinds or owners are not those of the schema's templates."""
    schema = "IFC4X3" if model.schema_identifier.startswith("IFC4X3") else model.schema
    templates = get_template(schema)
    faults = set()
    for owner in [*model.by_type("IfcProduct"), *model.by_type("IfcTypeProduct")]:
        if owner.is_a("IfcTypeObject"):
            sets = owner.HasPropertySets or ()
        else:
            sets = [relation.RelatingPropertyDefinition for relation in owner.IsDefinedBy if relation.is_a("IfcRelDefinesByProperties")]
        names = Counter(found.Name for found in sets)
        faults |= {f"{name} stands {number} times at one {owner.is_a()}" for name, number in names.items() if number > 1}
        for found in sets:
            if not found.Name.startswith(("Pset_", "Qto_")):
                continue
            template = templates.get_by_name(found.Name)
            if template is None:
                faults.add(f"{schema} has no {found.Name}")
            elif found.Name not in templates.get_applicable_names(owner.is_a(), get_predefined_type(owner) or "", schema=schema):
                faults.add(f"{found.Name} is not for {owner.is_a()} {get_predefined_type(owner)}")
            else:
                faults |= _template_faults(found, template)
    return sorted(faults)


def _template_faults(found, template):
    wanted = {item.Name: item for item in template.HasPropertyTemplates}
    faults = set()
    if found.is_a("IfcElementQuantity"):
        faults |= {f"{found.Name} has no {item.Name}" for item in found.Quantities if item.Name not in wanted}
        if found.MethodOfMeasurement != "BaseQuantities":
            faults.add(f"{found.Name}: MethodOfMeasurement is {found.MethodOfMeasurement}")
        return faults | {
            f"{found.Name}.{item.Name} is {item.is_a()}"
            for item in found.Quantities
            if item.Name in wanted and item.is_a().upper() != f"IFCQUANTITY{wanted[item.Name].TemplateType.removeprefix('Q_')}"
        }
    for item in found.HasProperties:
        if item.Name not in wanted:
            faults.add(f"{found.Name} has no {item.Name}")
            continue
        kind = wanted[item.Name].TemplateType
        if item.is_a().upper() != f"IFCPROPERTY{kind.removeprefix('P_')}":
            faults.add(f"{found.Name}.{item.Name} is {item.is_a()}, not {kind}")
        elif kind == "P_SINGLEVALUE" and item.NominalValue.is_a() != wanted[item.Name].PrimaryMeasureType:
            faults.add(f"{found.Name}.{item.Name} is {item.NominalValue.is_a()}, not {wanted[item.Name].PrimaryMeasureType}")
        elif kind == "P_ENUMERATEDVALUE":
            allowed = {value.wrappedValue for value in wanted[item.Name].Enumerators.EnumerationValues}
            faults |= {f"{found.Name}.{item.Name} is '{v.wrappedValue}'" for v in item.EnumerationValues if v.wrappedValue not in allowed}
    return faults


# ---------------------------------------------------------------- ports


@dataclass(frozen=True)
class PlacedPort:
    """A port of a file: its entity, origin (3,) mm and z axis (3,) in the file's world."""

    entity: object
    origin: np.ndarray
    axis: np.ndarray

    @property
    def flow(self):
        return self.entity.FlowDirection


def ports_of(product):
    """Return the ports nested in a product, in the order of the nesting."""
    return [part for relation in product.IsNestedBy for part in relation.RelatedObjects if part.is_a("IfcDistributionPort")]


def port_faults(model, pipeline):
    """Return what is wrong with the ports, connections and flow of a pipeline's components in a model."""
    faults = [f"{len(found)} IfcRelConnectsPortToElement" for found in [model.by_type("IfcRelConnectsPortToElement")] if found]
    products = products_by_tag(model)
    components = {component.id: component for component in pipeline.components}
    placed = {}
    for key, component in components.items():
        entities = ports_of(products[key])
        if len(entities) != len(component.ports):
            faults.append(f"{key}: {len(entities)} ports instead of {len(component.ports)}")
            continue
        if len({entity.Name for entity in entities}) != len(entities):
            faults.append(f"{key}: ports' names are not told apart: {[entity.Name for entity in entities]}")
        for number, entity in enumerate(entities):
            matrix = np.asarray(get_local_placement(entity.ObjectPlacement))
            placed[key, number] = PlacedPort(entity, matrix[:3, 3], matrix[:3, 2])
            if entity.PredefinedType != "PIPE":
                faults.append(f"{key} port {number}: PredefinedType {entity.PredefinedType}")
            if entity.ObjectPlacement.PlacementRelTo != products[key].ObjectPlacement:
                faults.append(f"{key} port {number}: is not placed relative to its component")
    nested = Counter(part.id() for relation in model.by_type("IfcRelNests") for part in relation.RelatedObjects)
    numbers = [(port, nested[port.id()]) for port in model.by_type("IfcDistributionPort")]
    faults += [f"port #{port.id()} {port.Name} is nested {number} times" for port, number in numbers if number != 1]
    return [
        *faults,
        *_connection_faults(model, pipeline, placed),
        *_joint_faults(pipeline, components, placed),
        *_open_faults(pipeline, components, placed),
        *_flow_faults(components, placed),
    ]


def _ends(joint):
    return (joint.a, int(joint.a_port)), (joint.b, int(joint.b_port))


def _connection_faults(model, pipeline, placed):
    """Return joints that are not connected exactly once, and connections without a joint."""
    pairs = Counter(frozenset((relation.RelatingPort.id(), relation.RelatedPort.id())) for relation in model.by_type("IfcRelConnectsPorts"))
    faults = []
    for joint in pipeline.joints:
        if all(end in placed for end in _ends(joint)):
            number = pairs.pop(frozenset(placed[end].entity.id() for end in _ends(joint)), 0)
            faults += [f"{joint.a}.{joint.a_port}-{joint.b}.{joint.b_port}: connected {number} times"] if number != 1 else []
    return faults + [f"ports {sorted(pair)} are connected without a joint" for pair in pairs]


def _joint_faults(pipeline, components, placed):
    """Return joints whose ports are not in one place near both ends, or whose axes and flows do not go on from one to the other."""
    faults = []
    for joint in pipeline.joints:
        if not all(end in placed for end in _ends(joint)):
            continue
        name = f"{joint.a}.{joint.a_port}-{joint.b}.{joint.b_port}"
        a, b = ports = [placed[end] for end in _ends(joint)]
        ends = [components[key].ports[number] for key, number in _ends(joint)]
        gap = math.dist(ends[0].point, ends[1].point) + JOINT_SLACK_MM
        misfit = math.degrees(_angle(ends[0].direction, -np.array(ends[1].direction))) + TURNED_DEG
        if (apart := np.linalg.norm(a.origin - b.origin)) > COINCIDENT_MM:
            faults.append(f"{name}: ports are {apart:.4f} mm apart")
        if {a.flow, b.flow} != {"SOURCE", "SINK"}:
            faults.append(f"{name}: flows {a.flow} to {b.flow}")
        if (turned := math.degrees(_angle(a.axis, b.axis))) > misfit:
            faults.append(f"{name}: the ports' axes differ by {turned:.4f} deg; both go with the flow")
        for port, end in zip(ports, ends, strict=True):
            if (apart := math.dist(port.origin, end.point)) > gap:
                faults.append(f"{name}: a port is {apart:.3f} mm from its component's end, more than the joint's gap of {gap:.3f} mm")
            faults += [f"{name}: {fault}" for fault in _axis_faults(port, end, misfit)]
    return faults


def _open_faults(pipeline, components, placed):
    """Return ports that no joint uses and that are not at their component's end."""
    joined = {end for joint in pipeline.joints for end in _ends(joint)}
    faults = []
    for (key, number), port in placed.items():
        if (key, number) not in joined:
            end = components[key].ports[number]
            if (apart := math.dist(port.origin, end.point)) > COINCIDENT_MM:
                faults.append(f"{key} port {number}: open, but {apart:.4f} mm from the end")
            faults += [f"{key} port {number}: {fault}" for fault in _axis_faults(port, end, TURNED_DEG)]
    return faults


def _axis_faults(port, end, misfit_deg):
    """Return whether a port's z axis goes out of its component where it is a source, into it where it is a sink."""
    if port.flow not in {"SOURCE", "SINK"}:
        return [f"flow direction is {port.flow}"]
    outwards = np.array(end.direction) if port.flow == "SOURCE" else -np.array(end.direction)
    turned = math.degrees(_angle(port.axis, outwards))
    return [f"axis of a {port.flow} is {turned:.4f} deg off"] if turned > misfit_deg else []


def _flow_faults(components, placed):
    """Return components that flow goes only into or only out of, although they have two ends or more."""
    faults = []
    for key, component in components.items():
        flows = {placed[key, number].flow for number in range(len(component.ports)) if (key, number) in placed}
        if len(component.ports) > 1 and flows and flows != {"SOURCE", "SINK"}:
            faults.append(f"{key}: flow does not pass through: {flows}")
    return faults


def system_faults(model, pipeline):
    """Return what is wrong with the distribution systems: one for each run, every component in one."""
    faults = []
    products = products_by_tag(model)
    system_of = defaultdict(set)
    for relation in model.by_type("IfcRelAssignsToGroup"):
        if relation.RelatingGroup.is_a("IfcDistributionSystem"):
            for item in relation.RelatedObjects:
                system_of[item.id()].add(relation.RelatingGroup.id())
    seen = {}
    for run in runs_of(pipeline.components, pipeline.joints):
        systems = [system_of[products[key].id()] for key in run]
        if not systems[0] or any(found != systems[0] for found in systems):
            faults.append(f"run {run[0]}...{run[-1]}: its components are in the systems {[sorted(found) for found in systems]}")
            continue
        own = frozenset(systems[0])
        if own in seen:
            faults.append(f"runs of {run[0]} and {seen[own]} share their systems")
        seen[own] = run[0]
    return faults + [f"{key}: in no system" for key, product in products.items() if not system_of[product.id()]]


def _angle(a, b):
    """Return the angle between two directions in rad, exact for small ones."""
    a, b = np.asarray(a, float), np.asarray(b, float)
    return math.atan2(float(np.linalg.norm(np.cross(a, b))), float(a @ b))


# ---------------------------------------------------------------- geometry


@dataclass(frozen=True)
class Body:
    """What a body takes up: volume in mm3, low and high corner (3,) mm."""

    volume: float
    low: np.ndarray
    high: np.ndarray


def true_body(component):
    """Return a component's body by closed formulas, where there are some; tees, caps and eccentric reducers as they are modelled."""
    match component:
        case Pipe():
            volume = _ring(component) * component.length
            rings = [(component.start, np.subtract(component.end, component.start)), (component.end, np.subtract(component.end, component.start))]
            return Body(volume, *_box(rings, component.outer_diameter / 2))
        case Elbow():
            # Guldin: the section's area along the way of its middle
            turns = np.linspace(0, math.radians(component.angle_deg), 721)
            come, go = (np.subtract(*pair) for pair in ((component.intersection, component.start), (component.end, component.intersection)))
            come = come / np.linalg.norm(come)
            aside = go - (go @ come) * come
            aside /= np.linalg.norm(aside)
            centre = np.array(component.start) + component.bend_radius * aside
            rings = [
                (centre + component.bend_radius * (math.sin(t) * come - math.cos(t) * aside), math.cos(t) * come + math.sin(t) * aside) for t in turns
            ]
            return Body(_ring(component) * math.radians(component.angle_deg) * component.bend_radius, *_box(rings, component.outer_diameter / 2))
        case Flange():
            return _turned(component, flange_outline(component), component.face, -np.array(component.axis), _holes(component))
        case Reducer() if component.reducer_type == "concentric":
            return _turned(component, reducer_outline(component), component.start, component.axis)
        case _:
            solid = component_solid(component)
            box = solid.BoundingBox()
            return Body(solid.Volume(), np.array([box.xmin, box.ymin, box.zmin]), np.array([box.xmax, box.ymax, box.zmax]))


def _ring(component):
    outer = component.outer_diameter / 2
    inner = outer - component.wall_thickness if component.wall_thickness is not None else 0.0
    return math.pi * (outer**2 - inner**2)


def _holes(flange):
    if flange.K is None or flange.L is None or flange.bolts is None:
        return 0.0
    height = flange.C
    if flange.raised_face_diameter and flange.raised_face_height and flange.K - flange.L >= flange.raised_face_diameter:
        height -= flange.raised_face_height  # the holes begin behind the raised face
    return flange.bolts * math.pi * (flange.L / 2) ** 2 * height


def _turned(component, outline, origin, axis, missing=0.0):
    """Return a body of revolution by Guldin's rule."""
    r, z = np.array(outline).T
    r2, z2 = np.roll(r, -1), np.roll(z, -1)
    volume = abs(math.pi / 3 * float(np.sum((r * z2 - r2 * z) * (r + r2))))
    rings = [(np.array(origin) + height * np.array(axis), axis, radius) for radius, height in outline]
    boxes = [_box([(middle, direction)], radius) for middle, direction, radius in rings]
    return Body(volume - missing, np.min([low for low, _ in boxes], axis=0), np.max([high for _, high in boxes], axis=0))


def _box(rings, radius):
    """Return the corners of the box about circles: centres and normals (not of length 1)."""
    centres = np.array([centre for centre, _ in rings])
    normals = np.array([normal for _, normal in rings])
    normals = normals / np.linalg.norm(normals, axis=1)[:, None]
    reach = radius * np.sqrt(np.clip(1 - normals**2, 0, None))
    return (centres - reach).min(axis=0), (centres + reach).max(axis=0)


def occ_bodies(model, kinds=COMPONENTS):
    """Return the bodies that Open CASCADE makes of a model's products of some kinds, exact ones, by Tag."""
    import cadquery

    settings = ifcopenshell.geom.settings()
    settings.set("iterator-output", ifcopenshell_wrapper.SERIALIZED)
    settings.set("use-world-coords", True)
    bodies = {}
    for tag, product in products_by_tag(model, kinds).items():
        shape = cadquery.Shape.importBrep(io.BytesIO(ifcopenshell.geom.create_shape(settings, product).geometry.brep_data.encode()))
        box = shape.BoundingBox()
        low, high = (1000 * np.array(corner) for corner in ((box.xmin, box.ymin, box.zmin), (box.xmax, box.ymax, box.zmax)))
        bodies[tag] = Body(shape.Volume() * 1e9, low, high)
    return bodies


def web_ifc_missing():
    """Return why web-ifc cannot be run; empty where it can."""
    if shutil.which("node") is None:
        return "node is not installed"
    return (
        ""
        if (READER.parent / "node_modules" / "web-ifc").is_dir()
        else "the npm package web-ifc is not installed (scripts/web_ifc/install.sh does it)"
    )


def web_ifc_bodies(path, kinds=COMPONENTS):
    """Return the bodies that web-ifc makes of a file's products of some kinds, by Tag."""
    node = shutil.which("node") or "node"
    done = subprocess.run([node, str(READER), str(path)], capture_output=True, text=True, check=False, env={**os.environ, "NODE_NO_WARNINGS": "1"})
    assert done.returncode == 0, done.stderr
    wanted = {kind.upper() for kind in kinds}
    products = [item for item in json.loads(done.stdout)[str(path)] if item["kind"].upper() in wanted]
    bodies = {item["tag"]: Body(item["volume"], np.array(item["low"]), np.array(item["high"])) for item in products}
    assert len(bodies) == len(products), "Tags are used twice"
    return bodies


def body_faults(bodies, pipeline, *, volume, box_mm):
    """Return what differs from the components' true bodies: counts, volumes by more than a part, boxes by more than so many mm."""
    wanted = {component.id: component for component in pipeline.components}
    if set(bodies) != set(wanted):
        return [f"missing: {sorted(set(wanted) - set(bodies))}; too many: {sorted(set(bodies) - set(wanted))}"]
    faults = []
    for key, component in wanted.items():
        truth, found = true_body(component), bodies[key]
        if abs(ratio := found.volume / truth.volume - 1) > volume:
            faults.append(f"{component.kind} {key}: volume {found.volume:.0f} instead of {truth.volume:.0f} mm3 ({100 * ratio:+.3f} %)")
        off = max(np.abs(found.low - truth.low).max(), np.abs(found.high - truth.high).max())
        if off > box_mm:
            faults.append(f"{component.kind} {key}: box off by {off:.3f} mm")
    return faults
