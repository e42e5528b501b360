# SPDX-License-Identifier: LGPL-2.1-or-later
"""Components of every kind in any pose, and what is joined to them: the adjustment's tests begin with these."""

from dataclasses import fields, replace

import numpy as np
from scipy.spatial.transform import Rotation
from synthetic import TARGET

from pipeworkbench.pipeline import Cap, Elbow, Flange, Joint, Pipe, Reducer, Tee, moved
from pipeworkbench.recon.contour import curves_of
from pipeworkbench.recon.cylinder import perpendicular_axes
from pipeworkbench.recon.edges import EdgeMap, _fill
from pipeworkbench.recon.shapes import shapes_of

DIAMETER, BRANCH = 114.3, 88.9
PARAMETERS = np.linspace(0.13, 0.87, 7)  # along a contour
KINDS = (
    "pipe",
    "elbow",
    "elbow by 45 degrees",
    "flange",
    "flange with a raised face",
    "flange with a hub",
    "flat flange",
    "tee",
    "concentric reducer",
    "eccentric reducer",
    "cap",
)


def straight(name="pipe", length=300.0, diameter=DIAMETER, **changes):
    """Return a pipe along x in the middle of the view."""
    half = np.array([length / 2, 0.0, 0.0])
    return Pipe(id=name, outer_diameter=diameter, **({"start": tuple(TARGET - half), "end": tuple(TARGET + half)} | changes))


def bend(name="elbow", angle_deg=90.0, bend_radius=152.0, diameter=DIAMETER, **changes):
    """Return an elbow that is entered along x and left upwards."""
    angle = np.radians(angle_deg)
    tangent = bend_radius * np.tan(angle / 2)
    go = np.array([np.cos(angle), 0.0, np.sin(angle)])
    start, end = np.subtract(TARGET, [tangent, 0, 0]), TARGET + tangent * go
    given = {"start": tuple(start), "end": tuple(end), "intersection": tuple(TARGET), "angle_deg": angle_deg, "bend_radius": bend_radius}
    return Elbow(id=name, outer_diameter=diameter, **(given | changes))


def plate(name="flange", **changes):
    """Return a weld neck flange of EN 1092-1, DN 100 PN 16, that looks along x."""
    sizes = {
        "face": tuple(TARGET),
        "axis": (1.0, 0.0, 0.0),
        "outer_diameter": DIAMETER,
        "D": 220.0,
        "C": 20.0,
        "length": 52.0,
        "neck_diameter": 131.0,
        "neck_straight": 12.0,
    }
    return Flange(id=name, pn=16, **({"flange_type": "11"} | sizes | changes))


def tee(name="tee", **changes):
    """Return a tee along x with its branch upwards."""
    ends = {"start": (-105.0, 0.0, 0.0), "end": (105.0, 0.0, 0.0), "intersection": (0.0, 0.0, 0.0), "branch_end": (0.0, 0.0, 98.0)}
    points = {key: tuple(np.add(TARGET, value)) for key, value in ends.items()}
    return Tee(id=name, outer_diameter=DIAMETER, branch_diameter=BRANCH, **(points | changes))


def cone(name="reducer", aside=0.0, **changes):
    """Return a reducer along x, eccentric where its ends lie ``aside`` (mm) of each other."""
    kind = "eccentric" if aside else "concentric"
    points = {"start": tuple(TARGET), "end": tuple(np.add(TARGET, [102.0, 0.0, aside]))}
    return Reducer(id=name, axis=(1.0, 0.0, 0.0), outer_diameter=DIAMETER, end_diameter=BRANCH, reducer_type=kind, **(points | changes))


def dish(name="cap", **changes):
    """Return a cap that closes a pipe along x."""
    return Cap(id=name, start=tuple(TARGET), axis=(1.0, 0.0, 0.0), outer_diameter=DIAMETER, **({"length": 64.0} | changes))


def part(kind, name=None):
    """Return a component of one of the :data:`KINDS`."""
    made = {
        "pipe": straight,
        "elbow": bend,
        "elbow by 45 degrees": lambda: bend(angle_deg=45.0, bend_radius=270.0),
        "flange": plate,
        "flange with a raised face": lambda: plate(raised_face_diameter=158.0, raised_face_height=3.0),
        "flange with a hub": lambda: plate(flange_type="12", neck_straight=None, length=40.0),
        "flat flange": lambda: plate(flange_type="01", length=20.0, neck_diameter=None, neck_straight=None),
        "tee": tee,
        "concentric reducer": cone,
        "eccentric reducer": lambda: cone(aside=12.7),
        "cap": dish,
    }[kind]()
    return made if name is None else replace(made, id=name)


def turned(component, turn, shift=(0.0, 0.0, 0.0)):
    """Return a component turned by a matrix (3, 3) about the middle of the view and then shifted."""
    return placed(component, turn, TARGET - turn @ TARGET + shift)


def placed(component, turn, shift):
    """Return a component after the motion X -> turn X + shift."""
    motion = np.column_stack([turn, shift])
    return moved(component, (*(tuple(map(float, row)) for row in motion), (0.0, 0.0, 0.0, 1.0)))


def in_pose(component, seed):
    """Return a component in a random pose before the cameras that is not looked at from its end."""
    random = np.random.default_rng(seed)
    own, aside, picture = random.uniform(-np.pi, np.pi), random.uniform(-0.8, 0.8), random.uniform(-np.pi, np.pi)
    return turned(component, Rotation.from_euler("YZX", [picture, aside, own]).as_matrix(), random.uniform(-150, 150, 3))


def attached(one, port, other, other_port, gap=0.0, turn=0.7):
    """Return the other component moved to a port of one, with a gap (mm), turned about the port's axis by ``turn`` (rad), and their joint."""
    here, there = one.ports[port], other.ports[other_port]
    way, come = np.array(here.direction), np.array(there.direction)
    frame = np.array([way, *perpendicular_axes(way)]).T
    back = np.array([-come, *perpendicular_axes(-come)]).T
    matrix = Rotation.from_rotvec(turn * way).as_matrix() @ frame @ (np.diag([1.0, 1.0, np.linalg.det(frame) * np.linalg.det(back)]) @ back.T)
    place = np.array(here.point) + gap * way
    return placed(other, matrix, place - matrix @ np.array(there.point)), Joint(a=one.id, a_port=port, b=other.id, b_port=other_port)


def richardson(function, step):
    """Return the derivative at 0 of a function of one number to arrays, from two central differences: its error goes with step^4."""
    wide, narrow = ((function(h) - function(-h)) / (2 * h) for h in (step, step / 2))
    return (4 * narrow - wide) / 3


def curves_seen(camera, component):
    return curves_of(shapes_of([component]), camera.projection_centre)


class Sight:
    """Regular points of a component's contours in one image, and how far the moved contours are from them."""

    def __init__(self, camera, component):
        self.camera = camera
        curves = curves_seen(camera, component)
        number = np.repeat(np.arange(len(curves.owner)), len(PARAMETERS))
        parameter = np.tile(PARAMETERS, len(curves.owner))
        ahead = curves.seen_by(camera, number, parameter + 1e-4).position - curves.seen_by(camera, number, parameter - 1e-4).position
        speed = np.linalg.norm(ahead, axis=1) / 2e-4
        # not where a curve nearly turns back on itself, nor where there is none
        speed = np.nan_to_num(speed)
        fastest = speed.reshape(-1, len(PARAMETERS)).max(axis=1).repeat(len(PARAMETERS))
        regular = speed > np.maximum(1.0, 0.2 * fastest)
        self.number, self.parameter = number[regular], parameter[regular]
        self.seen = curves.seen_by(camera, self.number, self.parameter)
        self.names = np.array(curves.names)[self.number]
        # by the distance and the parameter
        self.inverse = np.linalg.inv(np.stack([-self.seen.normal, ahead[regular] / 2e-4], axis=2))

    def __len__(self):
        return len(self.number)

    def distances(self, component, camera=None):
        """Return how far (n,), px, along the normals the contour of a moved component, or in a moved camera, cuts them: Newton's method."""
        camera = camera or self.camera
        curves = curves_seen(camera, component)
        distance, parameter = np.zeros(len(self)), self.parameter.copy()
        for _ in range(15):
            position = curves.seen_by(camera, self.number, parameter).position
            off = position - self.seen.position - distance[:, None] * self.seen.normal
            step = -np.einsum("nij,nj->ni", self.inverse, off)
            distance, parameter = distance + step[:, 0], parameter + step[:, 1]
            if np.abs(off).max(initial=0.0) < 1e-11:
                break
        assert np.abs(off).max(initial=0.0) < 1e-9
        return distance


def run():
    """Return a run and a pipe by itself, which no axis of is parallel to a base, with their joints: all seen by the synthetic cameras.

    Pipe A, elbow E, pipe B, flanges F and G, pipe C; pipe D.
    """
    corner, size = np.add(TARGET, [20.0, 0.0, -230.0]), {"dn": 100}
    lower, upper = np.add(corner, [0.0, 0.0, 152.0]), np.add(corner, [0.0, 0.0, 400.0])
    face, other = np.add(upper, [0.0, 0.0, 52.0]), np.add(upper, [0.0, 0.0, 54.0])
    made = [
        Pipe(id="A", start=tuple(np.subtract(corner, [480.0, 0, 0])), end=tuple(np.subtract(corner, [152.0, 0, 0])), outer_diameter=DIAMETER, **size),
        bend("E", start=tuple(np.subtract(corner, [152.0, 0, 0])), end=tuple(lower), intersection=tuple(corner), bend_type="3D", **size),
        Pipe(id="B", start=tuple(lower), end=tuple(upper), outer_diameter=DIAMETER, **size),
        plate("F", face=tuple(face), axis=(0.0, 0.0, 1.0), **size),
        plate("G", face=tuple(other), axis=(0.0, 0.0, -1.0), **size),
        Pipe(id="C", start=tuple(np.add(other, [0, 0, 52.0])), end=tuple(np.add(other, [0, 0, 230.0])), outer_diameter=DIAMETER, **size),
        Pipe(id="D", start=tuple(np.add(TARGET, [200.0, 50, -300])), end=tuple(np.add(TARGET, [500.0, -60, 60])), outer_diameter=60.3, dn=50),
    ]
    turn = Rotation.from_euler("yxz", [0.25, 0.15, 0.2]).as_matrix()
    pairs = ("A", 1, "E", 0), ("E", 1, "B", 0), ("B", 1, "F", 1), ("F", 0, "G", 0), ("G", 1, "C", 0)
    joints = tuple(Joint(a=a, a_port=a_port, b=b, b_port=b_port) for a, a_port, b, b_port in pairs)
    return tuple(turned(one, turn) for one in made), joints


def gaps(components, joints):
    """Return how far (mm) the ports of joints are apart."""
    by_id = {one.id: one for one in components}
    pairs = [(by_id[joint.a].ports[joint.a_port].point, by_id[joint.b].ports[joint.b_port].point) for joint in joints]
    return np.array([np.linalg.norm(np.subtract(*pair)) for pair in pairs])


def with_edges(view, rows, shift=0.0, **changes):
    """Return a view whose edge points in ``rows`` are shifted by so many px along their normals; other columns of all points are replaced."""
    edges = view.edges
    position = edges.position.copy()
    position[rows] += shift * edges.normal[rows]
    pixel = np.rint(position).astype(np.int32)
    index = np.full(edges.index.shape, -1, np.int32)
    _fill(index, pixel, position)
    columns = {f.name: getattr(edges, f.name) for f in fields(edges)} | {"position": position, "pixel": pixel, "index": index}
    return replace(view, edges=EdgeMap(**(columns | changes)))
