# SPDX-License-Identifier: LGPL-2.1-or-later
"""A plan with a covering of every kind, made by hand: two layers and a jacket around one of every kind of component."""

import math

import numpy as np

from pipeworkbench.insulation.planning import Piece, Plan
from pipeworkbench.insulation.runs import runs_of
from pipeworkbench.insulation.specification import Specification
from pipeworkbench.insulation.treatment import Treatment
from pipeworkbench.solids import Frame, frame_of
from pipeworkbench.solids.coverings import (
    BendCovering,
    BoxCovering,
    CapCovering,
    ConeCovering,
    Layer,
    Notch,
    Sheet,
    StopCovering,
    StraightCovering,
    TeeCovering,
)
from pipeworkbench.solids.frames import bend_angle, local_point

LAYERS = (Layer("mineral wool", 15.0), Layer("elastomeric foam", 10.0))
JACKET = Sheet("aluminium", 0.8)
TREATMENT = Treatment(layers=LAYERS, jacket=JACKET)
NOTCH = Notch("bracket", np.array((20.0, -200.0, 60.0)), np.array((20.0, 200.0, 60.0)), 15.0)
PARTS = {"layers": LAYERS, "sheet": JACKET}


def plan_of(pipeline, coverings):
    """Return a plan of coverings that were made by hand."""
    runs = runs_of(pipeline)
    pieces = tuple(Piece(covering, TREATMENT, runs[covering.component]) for covering in coverings)
    return Plan(pipeline=pipeline, specification=Specification(default=TREATMENT), pieces=pieces, clashes=(), problems=(), remarks=(), bare=())


def straight(pipe, **changes):
    """Return the covering of a whole pipe."""
    size = {"radius": pipe.outer_diameter / 2, "begin": 0.0, "end": pipe.length}
    return StraightCovering(id=f"I-{pipe.id}", component=pipe.id, frame=frame_of(pipe), **(PARTS | size | changes))


def bend(elbow, gores, collars):
    """Return the covering of an elbow."""
    size = {"radius": elbow.outer_diameter / 2, "bend_radius": elbow.bend_radius, "angle": bend_angle(elbow)}
    return BendCovering(id=f"I-{elbow.id}", component=elbow.id, frame=frame_of(elbow), gores=gores, collars=collars, **PARTS, **size)


def cone(reducer):
    """Return the covering of a reducer."""
    frame = frame_of(reducer)
    size = {"radius": reducer.outer_diameter / 2, "end_radius": reducer.end_diameter / 2, "length": reducer.length}
    offset = float(local_point(frame, reducer.end)[0])
    return ConeCovering(id=f"I-{reducer.id}", component=reducer.id, frame=frame, offset=offset, **PARTS, **size)


def tee(fitting, reach):
    """Return the covering of a tee."""
    frame = frame_of(fitting)
    begin, end = (float(local_point(frame, point)[2]) for point in (fitting.start, fitting.end))
    x, _, z = local_point(frame, fitting.branch_end)
    size = {"radius": fitting.outer_diameter / 2, "branch_radius": fitting.branch_diameter / 2, "branch_angle": math.atan2(x, z)}
    return TeeCovering(id=f"I-{fitting.id}", component=fitting.id, frame=frame, begin=begin, end=end, reach=reach, **PARTS, **size)


def stop(pipe):
    """Return the disc behind the insulation of a pipe."""
    frame = frame_of(pipe)
    behind = Frame(np.array(pipe.end), frame.x, frame.y, frame.z)
    radius = pipe.outer_diameter / 2
    size = {"layers": (), "sheet": JACKET, "radius": radius, "outer_radius": radius + 25.8}
    return StopCovering(id=f"I-{pipe.id}-stop", component=pipe.id, frame=behind, **size)


def plan_of_everything(pipeline):
    """Return the plan for one of everything: P4 has a notch, P5 stays bare, F1 and F2 have one box."""
    of = {component.id: component for component in pipeline.components}
    cap = CapCovering(id="I-C1", component="C1", frame=frame_of(of["C1"]), radius=of["C1"].outer_diameter / 2, length=of["C1"].length, **PARTS)
    hollow = {"radius": of["F1"].D / 2 + 20.0, "begin": -60.0, "end": of["F1"].length + 60.0, "openings": (0.0, of["F1"].outer_diameter / 2)}
    box = BoxCovering(id="I-F1", component="F1", components=("F1", "F2"), frame=frame_of(of["F1"]), **PARTS, **hollow)
    pipes = [straight(of["P1"]), straight(of["P2"], sheet=None), straight(of["P3"], layers=LAYERS[:1]), straight(of["P4"], notches=(NOTCH,))]
    bends = [bend(of["E1"], 4, (0.0, 30.0)), bend(of["E2"], 0, (10.0, 0.0))]
    rest = [cone(of["R1"]), cone(of["R2"]), tee(of["T1"], 80.0), cap, box, stop(of["P4"])]
    return plan_of(pipeline, [*pipes, *bends, *rest])
