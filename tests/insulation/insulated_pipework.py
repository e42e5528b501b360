# SPDX-License-Identifier: LGPL-2.1-or-later
"""Small pipework for the tests of insulation: components in a row, from a pen that draws along an axis."""

import math

import numpy as np

from pipeworkbench.insulation.specification import Specification
from pipeworkbench.insulation.treatment import Bends, Flanges, Seams, Treatment
from pipeworkbench.pipeline import Cap, Elbow, Flange, Joint, Pipe, Pipeline, Reducer, Tee
from pipeworkbench.solids.coverings import Layer, Sheet

DIAMETER, BEND_RADIUS = 60.3, 76.0
SHEET = 1.0
# EN 1092-1, type 11, PN 16, DN 50
PLATE = {"D": 165.0, "C": 18.0, "length": 45.0, "neck_diameter": 74.0, "neck_straight": 8.0, "K": 125.0, "L": 18.0, "bolts": 4}


def treatment(thickness=30.0, jacket=SHEET, *, bends=None, flanges=None, seams=None):
    """One layer with a jacket of 1 mm."""
    sheet = Sheet("steel", jacket) if jacket else None
    return Treatment((Layer("wool", thickness),), sheet, seams or Seams(), bends or Bends(), flanges or Flanges())


class Chosen(Specification):
    """A specification that says for some components what is to be done, whatever its rules."""

    choices: dict

    def treatment_of(self, component, run=None):  # noqa: ARG002
        if component.id in self.choices:
            return self.choices[component.id]
        return self.choices.get(component.kind, self.choices["default"])


def specification(default=None, choices=None, **rest):
    made = Chosen(**rest)
    object.__setattr__(made, "choices", {"default": default or treatment(), **(choices or {})})
    return made


class Pen:
    """Draws components from the origin along +x; ids count by kind."""

    def __init__(self, at=(0.0, 0.0, 0.0), along=(1.0, 0.0, 0.0), diameter=DIAMETER, prefix=""):
        self.at, self.along, self.diameter, self.prefix = np.array(at, float), np.array(along, float), diameter, prefix
        self.components, self.joints, self.open = [], [], None

    def name(self, letter):
        return f"{self.prefix}{letter}{1 + sum(c.id.startswith(self.prefix + letter) for c in self.components)}"

    def add(self, component, entered=0, left=1):
        if self.open:
            self.joints.append(Joint(a=self.open[0], a_port=self.open[1], b=component.id, b_port=entered))
        self.components.append(component)
        self.open = (component.id, left)
        return self

    def moved(self, way):
        start = tuple(self.at.tolist())
        self.at = self.at + way * self.along
        return {"start": start, "end": tuple(self.at.tolist()), "outer_diameter": self.diameter}

    def pipe(self, length):
        return self.add(Pipe(id=self.name("P"), **self.moved(length)))

    def elbow(self, towards, angle_deg=90.0, bend_radius=BEND_RADIUS):
        angle, start = math.radians(angle_deg), self.at
        go = math.cos(angle) * self.along + math.sin(angle) * np.array(towards, float)
        tangent = bend_radius * math.tan(angle / 2)
        corner = start + tangent * self.along
        self.at, self.along = corner + tangent * go, go
        points = {"start": tuple(start.tolist()), "intersection": tuple(corner.tolist()), "end": tuple(self.at.tolist())}
        return self.add(Elbow(id=self.name("E"), **points, angle_deg=angle_deg, bend_radius=bend_radius, outer_diameter=self.diameter))

    def flange(self, *, faces_on=True, **changes):
        """A flange whose face looks onwards, or back where the pipe comes behind it."""
        size = PLATE | changes
        axis = self.along if faces_on else -self.along
        face = self.at + (size["length"] if faces_on else 0.0) * self.along
        self.at = self.at + size["length"] * self.along
        kind = {"flange_type": "11", "pn": 16.0, "outer_diameter": self.diameter} | size
        flange = Flange(id=self.name("F"), face=tuple(face.tolist()), axis=tuple(axis.tolist()), **kind)
        return self.add(flange, *((1, 0) if faces_on else (0, 1)))

    def blind(self):
        size = {key: value for key, value in PLATE.items() if not key.startswith("neck")} | {"length": PLATE["C"], "flange_type": "05"}
        return self.flange(faces_on=False, **size, neck_diameter=None, neck_straight=None)

    def gap(self, way, *, joined=False):
        self.at = self.at + way * self.along
        self.open = self.open if joined else None
        return self

    def tee(self, half=64.0, branch=51.0, branch_diameter=33.7, towards=(0.0, 0.0, 1.0)):
        middle = self.at + half * self.along
        end = middle + branch * np.array(towards, float)
        tee = Tee(
            id=self.name("T"),
            **self.moved(2 * half),
            intersection=tuple(middle.tolist()),
            branch_end=tuple(end.tolist()),
            branch_diameter=branch_diameter,
        )
        return self.add(tee)

    def branch(self, length):
        """A pipe at the last tee's branch, beside the pen's way."""
        tee = self.components[-1]
        port = tee.ports[2]
        end = np.array(port.point) + length * np.array(port.direction)
        pipe = Pipe(id=self.name("B"), start=tee.branch_end, end=tuple(end.tolist()), outer_diameter=tee.branch_diameter)
        self.components.append(pipe)
        self.joints.append(Joint(a=tee.id, a_port=2, b=pipe.id, b_port=0))
        return self

    def reducer(self, end_diameter=48.3, length=76.0):
        reducer = Reducer(id=self.name("R"), **self.moved(length), axis=tuple(self.along.tolist()), end_diameter=end_diameter)
        self.diameter = end_diameter
        return self.add(reducer)

    def cap(self, length=38.0):
        cap = Cap(id=self.name("C"), start=tuple(self.at.tolist()), axis=tuple(self.along.tolist()), outer_diameter=self.diameter, length=length)
        return self.add(cap)

    def pipeline(self, *others):
        pens = (self, *others)
        return Pipeline(frame="A", components=tuple(c for pen in pens for c in pen.components), joints=tuple(j for pen in pens for j in pen.joints))
