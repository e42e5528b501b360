# SPDX-License-Identifier: LGPL-2.1-or-later
"""The insulation of whole plants, compared with formulas and points in space that know nothing of its solids and patterns."""

import dataclasses
import functools
import io
import itertools
import math
from pathlib import Path

import cadquery
import ezdxf
import grown
import ifcopenshell.geom
import numpy as np
import pytest
from ifcopenshell import ifcopenshell_wrapper
from OCP.BRep import BRep_Tool
from OCP.BRepCheck import BRepCheck_Analyzer
from pattern_checks import check_all, text_corners
from pipe_rack import pipe_rack
from points_inside import in_covering, in_metal

from pipeworkbench.exports.ifc import IfcOptions, ifc_model
from pipeworkbench.exports.insulation_files import Insulated, write
from pipeworkbench.exports.labels import labels_of_sheets
from pipeworkbench.insulation.clashes import TOUCH_MM
from pipeworkbench.insulation.energy import energy_of
from pipeworkbench.insulation.planning import plan
from pipeworkbench.insulation.rules import Changes, JacketSpec, LayerSpec
from pipeworkbench.insulation.specification import Block, Obstacle, Specification
from pipeworkbench.pipeline import Pipeline
from pipeworkbench.solids.covering_quantities import layer_volumes
from pipeworkbench.solids.coverings import BendCovering, BoxCovering, Layer, StopCovering
from pipeworkbench.solids.insulation import covering_bodies

DATA = Path(__file__).parent.parent / "data"
# points evenly in a unit cube: multiples of powers of the root of x^4 = x + 1 (Roberts 2018)
STEPS = 1.2207440846057596 ** -np.arange(1.0, 4.0)
OVERLAP_MM3 = 1000.0  # what two bodies may have in common
MOST_METAL_MM = 200.0  # how far components reach beside their ends


def simulated(seed, count):
    components, joints = grown.simulated_pipeline(np.random.default_rng(seed), count)
    return Pipeline(frame="A", components=components, joints=joints)


def wanted(*thicknesses, jacket=True, obstacles=(), **changes):
    materials = itertools.cycle(("mineral wool", "elastomeric foam"))
    layers = tuple(LayerSpec(material, thickness) for material, thickness in zip(materials, thicknesses, strict=False))
    sheet = JacketSpec("aluminium") if jacket else None
    return Specification(default=Changes(layers=layers, jacket=sheet, **changes), obstacles=obstacles)


COLUMN = Obstacle(id="column", start=(-220.0, 3300.0, 367.0), end=(-180.0, 3900.0, 367.0), diameter=40.0)
BEAM = Block(id="beam", lower=(-600.0, 3642.0, 200.0), upper=(-550.0, 3700.0, 400.0))
PLANTS = {
    "everything": lambda: Pipeline.read(DATA / "one_of_everything.json"),
    "dummy": lambda: Pipeline.read(DATA / "dummy.json"),
    "rack": lambda: pipe_rack(24, 1),
    "simulated": lambda: simulated(2, 20),
}
CASES = {
    "everything, two layers, obstacles": ("everything", wanted(20.0, 20.0, obstacles=(COLUMN, BEAM))),
    "everything, thick": ("everything", wanted(100.0)),
    "dummy, thick, equal gores": ("dummy", wanted(60.0, bends={"first_gore": "equal"})),
    "rack, smooth, bare flanges": ("rack", wanted(30.0, bends={"shape": "smooth"}, flanges={"cover": "bare"})),
    "simulated, two layers, longer gores": ("simulated", wanted(20.0, 40.0, bends={"first_gore": 20.0})),
    "everything without a jacket": ("everything", wanted(40.0, jacket=False)),
}


@functools.cache
def planned(case):
    name, specification = CASES[case]
    found = plan(PLANTS[name](), specification)
    while found.problems:
        found = found.without(found.problems)
    return found


@functools.cache
def insulated(case):
    return Insulated(planned(case))


@functools.cache
def modelled(case):
    """The bodies of each covering, in its own axes."""
    return [(piece.covering, covering_bodies(piece.covering)) for piece in planned(case).pieces]


def unfolded(case):
    """The patterns of each covering."""
    made = insulated(case)
    return [(piece.covering, [pattern for pattern in made.patterns if pattern.covering == piece.covering.id]) for piece in made.plan.pieces]


def summed(bodies):
    """Return the volume of each layer, both halves and all parts of it."""
    groups = itertools.groupby(bodies, lambda body: body.name.split(",")[0])
    return [sum(body.solid.Volume() for body in group) for _, group in groups]


def spread(covering, bodies, count):
    """Return points (n, 3) of the pipeline evenly in the box around a covering's bodies, and the volume for which each stands."""
    boxes, frame = [body.solid.BoundingBox() for body in bodies], covering.frame
    low = np.array([min(getattr(box, name) for box in boxes) for name in ("xmin", "ymin", "zmin")])
    high = np.array([max(getattr(box, name) for box in boxes) for name in ("xmax", "ymax", "zmax")])
    points = low + np.outer(np.arange(1, count + 1), STEPS) % 1.0 * (high - low)
    return frame.origin + points @ np.array([frame.x, frame.y, frame.z]), np.prod(high - low) / count


@pytest.mark.slow
@pytest.mark.parametrize("case", CASES)
def test_bodies_are_sound_and_as_large_as_formulas_say(case):
    for covering, bodies in modelled(case):
        for body in bodies:
            assert BRepCheck_Analyzer(body.solid.wrapped).IsValid()
            assert body.solid.ShapeType() == "Solid"
            assert all(BRep_Tool.IsClosed_s(shell.wrapped) for shell in body.solid.Shells())
            assert body.solid.Volume() > 0
        if not covering.notches:
            assert summed(bodies) == pytest.approx(layer_volumes(covering), rel=1e-6), covering.id


@pytest.mark.slow
@pytest.mark.parametrize("case", [case for case in CASES if "thick" in case or "obstacles" in case])
def test_what_notches_leave_is_as_large_as_points_say(case):
    cut = [(covering, bodies) for covering, bodies in modelled(case) if covering.notches and not isinstance(covering, StopCovering)]
    assert cut
    for covering, bodies in cut:
        plain = dataclasses.replace(covering, notches=())
        points, share = spread(covering, covering_bodies(plain), 200_000)
        for (inner, outer), left, whole in zip(itertools.pairwise(covering.boundaries), summed(bodies), layer_volumes(covering), strict=True):
            there = in_covering(plain, points, outer, inner)
            taken = there & ~in_covering(covering, points, outer, inner)
            assert whole - left == pytest.approx(taken.sum() * share, abs=4 * math.sqrt(taken.sum() + 1) * share), covering.id


@pytest.mark.slow
@pytest.mark.parametrize("case", CASES)
def test_coverings_take_no_room_of_each_other_nor_of_metal(case):
    found = planned(case)
    near = {name: {name} for name in (component.id for component in found.pipeline.components)}
    for joint in found.pipeline.joints:
        near[joint.a].add(joint.b)
        near[joint.b].add(joint.a)
    coverings = [piece.covering for piece in found.pieces]
    clouds = [inside_points(covering, bodies) for covering, bodies in modelled(case)]
    # the finer points tell more
    finest = sorted(range(len(coverings)), key=lambda number: clouds[number][1])
    for first, second in itertools.combinations(finest, 2):
        covering, other, (points, share) = coverings[first], coverings[second], clouds[first]
        if not meet(points, clouds[second][0]):
            continue
        common = in_covering(other, points).sum() * share
        assert common < allowed(covering, members(covering), members(other), near), (covering.id, other.id)
    for (covering, (points, share)), component in itertools.product(zip(coverings, clouds, strict=True), found.pipeline.components):
        ends = np.array([port.point for port in component.ports])
        if not meet(points, np.concatenate([ends - MOST_METAL_MM, ends + MOST_METAL_MM])):
            continue
        common = in_metal(component, points).sum() * share
        assert common < allowed(covering, members(covering), {component.id}, near), (covering.id, component.id)


def meet(one, other):
    """Tell whether the boxes around points (n, 3) and (m, 3) overlap."""
    return bool((one.min(axis=0) < other.max(axis=0)).all() and (other.min(axis=0) < one.max(axis=0)).all())


def members(covering):
    return set(covering.components) if isinstance(covering, BoxCovering) else {covering.component}


def inside_points(covering, bodies):
    points, share = spread(covering, bodies, 25_000)
    return points[in_covering(covering, points)], share


def allowed(covering, names, others, near):
    """Return what the misfits of measured neighbours explain: a thin wedge between their ends."""
    if any(near[name] & others for name in names):
        outer = covering.outer_radius if isinstance(covering, StopCovering) else covering.radius + covering.total_thickness
        return max(OVERLAP_MM3, math.pi * outer**2 * TOUCH_MM)
    return OVERLAP_MM3


@pytest.mark.slow
@pytest.mark.parametrize("case", [case for case in CASES if "without" not in case])
def test_patterns_are_as_large_as_the_middle_of_the_sheet(case):
    names = []
    for covering, patterns in unfolded(case):
        names += [pattern.id for pattern in patterns]
        if isinstance(covering, BendCovering) and not covering.gores:
            assert patterns == []
            continue
        check_all(patterns)
        # what is only marked takes nothing
        if not any("to be cut on site" in remark for pattern in patterns for remark in pattern.remarks):
            net = sum(pattern.net_area * pattern.quantity for pattern in patterns)
            assert net == pytest.approx(middle_area(covering), rel=1e-3), covering.id
    assert len(set(names)) == len(names)


def middle_area(covering):
    """Return the area of the outer faces of a covering that ends in the middle of its jacket's sheet."""
    if isinstance(covering, StopCovering):
        return sum(face.Area() for body in covering_bodies(covering) for face in body.faces["outer"])
    half = covering.sheet.thickness / 2
    grown_by_half = dataclasses.replace(covering, layers=(Layer("all", covering.thickness + half),), sheet=None)
    if isinstance(covering, BoxCovering):
        grown_by_half = dataclasses.replace(grown_by_half, begin=covering.begin + half, end=covering.end - half)
    return sum(face.Area() for body in covering_bodies(grown_by_half) for face in body.faces["outer"])


@pytest.mark.slow
def test_texts_lie_beside_the_marks():
    for covering, patterns in unfolded("everything, thick"):
        for pattern in patterns:
            scribed = [
                path.at(*map(np.concatenate, zip(*(along(path, k) for k in range(len(path.segments[2]))), strict=True))) for _, path in pattern.marks
            ]
            for text in pattern.texts:
                low, high = text_corners(text).min(axis=0), text_corners(text).max(axis=0)
                assert not any(((points > low) & (points < high)).all(axis=1).any() for points in scribed), (covering.id, text)


def along(path, segment):
    """Return places on a path's segment, no further than 0.5 mm apart."""
    count = max(int(np.hypot(*np.ptp(path.sampled(), axis=0))) * 4, 2)
    return np.full(count, segment), np.arange(count) / count


def test_without_a_jacket_nothing_is_cut():
    assert not any(patterns for _, patterns in unfolded("everything without a jacket"))


@pytest.mark.slow
@pytest.mark.parametrize("case", ["everything, two layers, obstacles"])
def test_files_say_what_the_plan_says(case, tmp_path):
    found = planned(case)
    made = insulated(case)
    for ending in ("step", "dxf"):
        write(made, tmp_path / f"insulation.{ending}")
    volumes = {covering.id: sum(summed(bodies)) for covering, bodies in modelled(case)}
    solids = cadquery.importers.importStep(str(tmp_path / "insulation.step")).solids().vals()
    metal = cadquery.importers.importStep(str(written_without(found, tmp_path))).solids().vals()
    assert sum(s.Volume() for s in solids) - sum(s.Volume() for s in metal) == pytest.approx(sum(volumes.values()), rel=1e-6)
    assert ifc_volumes(ifc_model(found.pipeline, options=IfcOptions(plan=found))) == pytest.approx(volumes, rel=1e-3)
    drawing = ezdxf.readfile(tmp_path / "insulation.dxf")
    assert not drawing.audit().errors
    cut = [entity for entity in drawing.modelspace() if entity.dxf.layer == "CUT"]
    outlines = [entity for entity in cut if entity.dxftype() == "LWPOLYLINE"]
    assert all(entity.closed for entity in outlines)
    assert len(cut) == sum(pattern.quantity * (1 + len(pattern.holes)) for pattern in made.patterns)
    assert {entity.get_xdata("PIPEWORKBENCH")[0].value for entity in cut} == {pattern.id for pattern in made.patterns}


def ifc_volumes(model):
    """Return the volumes (mm3) that Open CASCADE finds in a model's coverings, by Tag."""
    settings = ifcopenshell.geom.settings()
    settings.set("iterator-output", ifcopenshell_wrapper.SERIALIZED)
    shapes = {one.Tag: ifcopenshell.geom.create_shape(settings, one).geometry.brep_data for one in model.by_type("IfcCovering")}
    return {tag: cadquery.Shape.importBrep(io.BytesIO(data.encode())).Volume() * 1e9 for tag, data in shapes.items()}


def written_without(found, folder):
    from pipeworkbench.exports.step import write_step

    write_step(found.pipeline, folder / "metal.step")
    return folder / "metal.step"


@pytest.mark.slow
@pytest.mark.parametrize("case", CASES)
def test_lists_add_up(case):
    made = insulated(case)
    lists = made.lists
    volume = sum(sum(layer_volumes(piece.covering)[: len(piece.covering.layers)]) for piece in made.plan.pieces) * 1e-9
    assert sum(row["volume_m3"] for row in lists.insulation) == pytest.approx(volume, abs=1e-6)
    assert sum(row["volume_m3"] for row in lists.sections) == pytest.approx(volume, abs=1e-6)
    area = sum(pattern.cut_area * pattern.quantity for pattern in made.patterns) * 1e-6
    assert sum(row["total_area_m2"] for row in lists.cuts) == pytest.approx(area, abs=1e-6)
    assert sum(row["parts_area_m2"] for row in lists.metals) == pytest.approx(area, abs=1e-5)
    assert sum(row["pieces"] for row in lists.sheets) == sum(row["quantity"] for row in lists.cuts)
    runs = {f"R{number}" for number in range(1, 99)}
    assert {row["run"] for row in lists.cuts} <= runs
    assert {label.run for label in labels_of_sheets(made.sheets, made.runs)} <= runs


@pytest.mark.parametrize("name", PLANTS)
def test_energy_adds_up_and_insulation_saves(name):
    specification = wanted(60.0).with_operation({"medium_temperature": 130.0, "price_per_kwh": 0.1})
    energy = energy_of(PLANTS[name](), specification)
    assert energy.bare.heat == pytest.approx(sum(row.bare.heat for row in energy.rows))
    assert energy.insulated.energy == pytest.approx(sum(row.insulated.energy for row in energy.rows))
    assert energy.saved.cost == pytest.approx(energy.bare.cost - energy.insulated.cost)
    assert all(row.insulated.heat < row.bare.heat for row in energy.rows)
