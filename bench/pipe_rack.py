# SPDX-License-Identifier: LGPL-2.1-or-later
"""Plants of any size, as measured: runs beside each other with all kinds of components and the small misfits that measuring leaves.

No two pipes are alike and no two elbows turn by the same angle; flanges stand a gasket apart and not quite where the pipe's end was found.
"""

import math
from dataclasses import dataclass

import numpy as np

from pipeworkbench.pipeline import AnyComponent, Cap, Elbow, Flange, Joint, Pipe, Pipeline, Reducer, Tee, Vector

SPACING_MM = 6000.0  # between runs
ROW = 25  # runs beside each other
GASKET_MM = 2.0
WELD_MM, WELD_RAD = 0.3, 0.003  # standard deviations of a flange's place and direction from the end of its pipe
LENGTHS_MM = (120.0, 1500.0)
ANGLES_DEG = ((90.0, 0.7), (45.0, 0.3))  # of elbows, with their shares
ANGLE_SIGMA_DEG = 0.1
BEND = 1.5  # bend radius in nominal diameters of EN 10253's model 3D
LAST_RUN = 3  # components fewer than this make no run


@dataclass(frozen=True)
class Size:
    """A pipe's dimensions and those of the type 11, PN 16 flange on it (EN 10220, EN 10253-2, EN 1092-1), mm."""

    dn: int
    outer_diameter: float
    wall_thickness: float
    bend_radius: float
    tee: float
    reducer: float
    plate: dict[str, float | int]


def _plate(outside: float, thick: float, length: float, neck: float, circle: float, bolts: int, face: float) -> dict[str, float | int]:
    return {
        "D": outside,
        "C": thick,
        "length": length,
        "neck_diameter": neck,
        "neck_straight": 8.0,
        "K": circle,
        "L": 18.0,
        "bolts": bolts,
        "raised_face_diameter": face,
        "raised_face_height": 3.0,
    }


SIZES = (
    Size(50, 60.3, 2.9, 76.0, 64.0, 76.0, _plate(165.0, 18.0, 45.0, 74.0, 125.0, 4, 102.0)),
    Size(80, 88.9, 3.2, 114.0, 86.0, 89.0, _plate(200.0, 20.0, 50.0, 105.0, 160.0, 8, 138.0)),
    Size(100, 114.3, 3.6, 152.0, 105.0, 102.0, _plate(220.0, 20.0, 52.0, 131.0, 180.0, 8, 158.0)),
)
BRANCH = {"dn": 25, "outer_diameter": 33.7, "wall_thickness": 2.6}
SMALLER = {"dn": 40, "outer_diameter": 48.3, "wall_thickness": 2.6}
CAP_MM, BRANCH_CAP_MM = 38.0, 38.0
# a run's components after its first pipe, again and again; each letter is a step of the pen
COURSE = "EPEPTPEPXPEPRPEPEPF"


def pipe_rack(count: int, seed: int = 0) -> Pipeline:
    """Return a plant of so many components in runs of some twenty to fifty, with its joints.

    Parameters
    ----------
    count : int
        Components in total.
    seed : int
        Of what is random: lengths, angles, misfits and accuracies.
    """
    random = np.random.default_rng(seed)
    components: list[AnyComponent] = []
    joints: list[Joint] = []
    while (room := count - len(components)) > 0:
        number = len({component.id.split("-")[0] for component in components})
        run = _Run(random, f"R{number:03d}", SIZES[number % len(SIZES)], ((number % ROW) * SPACING_MM, number // ROW * SPACING_MM, 0.0))
        run.draw(room)
        components += run.components
        joints += run.joints
    return Pipeline.from_dict(Pipeline(frame="rack", components=tuple(components), joints=tuple(joints)).to_dict())


class _Run:
    """A pen that leaves components behind: at ``at``, looking along ``along``; what was drawn last ends there."""

    def __init__(self, random: np.random.Generator, name: str, size: Size, at: Vector) -> None:
        self.random, self.name, self.plate = random, name, size
        self.size = {"dn": size.dn, "outer_diameter": size.outer_diameter, "wall_thickness": size.wall_thickness}
        self.at, self.along, self.aside = np.array(at), np.array([0.0, 0.0, 1.0]), np.array([1.0, 0.0, 0.0])
        self.components: list[AnyComponent] = []
        self.joints: list[Joint] = []
        self.open: tuple[str, int] | None = None

    def draw(self, room: int) -> None:
        """Draw until the course is through or so many components are drawn."""
        if room >= LAST_RUN:
            self.blind_flange()
            self.flange(first=True)
        steps = {"E": self.elbow, "P": self.pipe, "T": self.tee, "X": self.flanges, "R": self.reducer, "F": self.end}
        costs = {"T": 3, "X": 2}
        self.pipe()
        for letter in COURSE:
            if len(self.components) + costs.get(letter, 1) > room:
                break
            steps[letter]()

    def pipe(self) -> None:
        """A pipe of any length."""
        length = float(self.random.uniform(*LENGTHS_MM))
        start, end = self.at, self.at + length * self.along
        known = {"standard": "EN 10220", "verified": 2, "sigma_outer_diameter": 0.1}
        self._add(Pipe(id=self._name("P"), start=_vector(start), end=_vector(end), **self.size, **self._measured(), **known))
        self.at = end

    def elbow(self) -> None:
        """A bend to any side, by nearly a usual angle."""
        angles, shares = zip(*ANGLES_DEG, strict=True)
        nominal = float(self.random.choice(angles, p=shares))
        angle_deg = nominal + round(float(self.random.normal(0.0, ANGLE_SIGMA_DEG)), 4)
        angle, radius = math.radians(angle_deg), BEND * self.size["dn"] if self.size["dn"] == SMALLER["dn"] else self.plate.bend_radius
        side = self.random.choice([self.aside, -self.aside, np.cross(self.along, self.aside), -np.cross(self.along, self.aside)])
        onwards = math.cos(angle) * self.along + math.sin(angle) * side
        corner = self.at + radius * math.tan(angle / 2) * self.along
        end = corner + radius * math.tan(angle / 2) * onwards
        points = {"start": _vector(self.at), "intersection": _vector(corner), "end": _vector(end)}
        known = {"standard": "EN 10253 / DIN 2605", "verified": 1, "bend_type": "3D", "angle_deg": angle_deg, "bend_radius": radius}
        self._add(Elbow(id=self._name("E"), **points, **self.size, **self._measured(), **known))
        self.aside = np.cross(side, self.along)
        self.at, self.along = end, onwards

    def tee(self) -> None:
        """A tee with a branch that a cap closes."""
        half, reach = self.plate.tee, self.plate.tee
        middle, end = self.at + half * self.along, self.at + 2 * half * self.along
        branch_end = middle + reach * self.aside
        tee = Tee(
            id=self._name("T"),
            start=_vector(self.at),
            end=_vector(end),
            intersection=_vector(middle),
            branch_end=_vector(branch_end),
            branch_diameter=BRANCH["outer_diameter"],
            standard="EN 10253-2",
            verified=1,
            **self.size,
            **self._measured(),
        )
        self._add(tee)
        length = float(self.random.uniform(*LENGTHS_MM)) / 2
        cap_at = branch_end + length * self.aside
        branch = Pipe(id=self._name("P"), start=tee.branch_end, end=_vector(cap_at), standard="EN 10220", verified=2, **BRANCH, **self._measured())
        cap = Cap(id=self._name("C", 1), start=branch.end, axis=_vector(self.aside), length=BRANCH_CAP_MM, verified=0, **BRANCH, **self._measured())
        self.components += [branch, cap]
        self.joints += [Joint(a=tee.id, a_port=2, b=branch.id, b_port=0), Joint(a=branch.id, a_port=1, b=cap.id, b_port=0)]
        self.at = end

    def reducer(self) -> None:
        """A concentric reducer to a smaller size, which the rest of the run has."""
        end = self.at + self.plate.reducer * self.along
        places = {"start": _vector(self.at), "end": _vector(end), "axis": _vector(self.along), "end_diameter": SMALLER["outer_diameter"]}
        self._add(Reducer(id=self._name("R"), standard="EN 10253-2", verified=1, **places, **self.size, **self._measured()))
        self.size, self.at = dict(SMALLER), end

    def flanges(self) -> None:
        """Two flanges face to face."""
        self.flange(first=False)
        self.at = self.at + GASKET_MM * self.along
        self.flange(first=True)

    def flange(self, *, first: bool) -> None:
        """A weld neck flange before a pipe or after one; it stands where it was measured, not where the pipe ends."""
        length = float(self.plate.plate["length"])
        axis = self.along + self.random.normal(0.0, WELD_RAD, 3)
        axis /= np.linalg.norm(axis) * (-1.0 if first else 1.0)
        place = self.at + (0.0 if first else length) * self.along + self.random.normal(0.0, WELD_MM, 3)
        known = {"standard": "EN 1092-1", "flange_type": "11", "pn": 16.0, "verified": 1}
        same = ({"standard": "DIN 2633", "flange_type": "11", "pn": 16.0},)
        dimensions = {**known, **self.plate.plate, "equivalents": same}
        flange = Flange(id=self._name("F"), face=_vector(place), axis=_vector(axis), **dimensions, **self.size, **self._measured())
        self._add(flange, 0 if first else 1)
        self.at = self.at + length * self.along

    def blind_flange(self) -> None:
        """A blind flange, which a run begins with."""
        known = {"standard": "EN 1092-1", "flange_type": "05", "pn": 16.0, "verified": 0}
        plate = {key: value for key, value in self.plate.plate.items() if not key.startswith("neck")} | {"length": self.plate.plate["C"]}
        self._add(Flange(id=self._name("F"), face=_vector(self.at), axis=_vector(self.along), **known, **plate, **self.size, **self._measured()))
        self.open = (self.components[-1].id, 0)
        self.at = self.at + GASKET_MM * self.along

    def end(self) -> None:
        """A cap, which a run ends with."""
        places = {"start": _vector(self.at), "axis": _vector(self.along)}
        self._add(Cap(id=self._name("C"), length=CAP_MM, standard="EN 10253-2", verified=1, **places, **self.size, **self._measured()))

    def _add(self, component: AnyComponent, port: int = 0) -> None:
        if self.open is not None:
            self.joints.append(Joint(a=self.open[0], a_port=self.open[1], b=component.id, b_port=port))
        self.components.append(component)
        self.open = (component.id, 1 - port)

    def _name(self, letter: str, ahead: int = 0) -> str:
        return f"{self.name}-{letter}{len(self.components) + ahead:02d}"

    def _measured(self) -> dict[str, object]:
        """Return what a measurement knows of a component."""
        sigma = tuple(round(float(value), 4) for value in self.random.uniform(0.05, 0.9, 3))
        return {
            "station": "A",
            "quality": round(float(self.random.uniform(0.2, 1.5)), 4),
            "sigma_position": sigma,
            "sigma_direction_deg": round(float(self.random.uniform(0.01, 0.1)), 5),
            "loa": "LOA40",
        }


def _vector(values: np.ndarray) -> Vector:
    x, y, z = values.tolist()
    return x, y, z
