# SPDX-License-Identifier: LGPL-2.1-or-later
"""The network adjustment in rounds: correspondences are looked for anew with the adjusted poses, what stays undetermined leaves."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from pipeworkbench.recon.registration.hypotheses import Pairs
from pipeworkbench.recon.registration.network import NetworkSolution, adjust_network
from pipeworkbench.recon.registration.observations import Observations, observations_of, observations_of_points
from pipeworkbench.recon.registration.poses import Pose
from pipeworkbench.recon.registration.results import PairResidual
from pipeworkbench.recon.registration.settings import RegistrationSettings
from pipeworkbench.recon.registration.stations import PLANT, Stations
from pipeworkbench.recon.registration.verification import explained_pairs

CONTRADICTING_SHARE = 1 / 3  # of the control points of a station: more that do not fit, and none can be trusted
CONTROL_POINT = "control point"


@dataclass(frozen=True, eq=False)
class Solved:
    """Adjusted stations: their ``rows`` among all, the solution in that order, one residual per observed pair.

    ``lost`` holds for stations that had to leave, by row, a sentence why; ``remarks`` are sentences about those that stay.
    """

    rows: tuple[int, ...]
    solution: NetworkSolution
    pairs: tuple[PairResidual, ...]
    lost: Mapping[int, str]
    remarks: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class _Links:
    """Observations and, in the same order, (station a, id a, station b, id b, kind) of each."""

    observations: Observations
    labels: list[tuple[int, str, int, str, str]]


_NOTHING = _Links(
    Observations(
        np.zeros((0, 2), np.intp), np.zeros((0, 2, 3)), np.zeros((0, 2, 3)), np.zeros((0, 4, 6)), np.zeros((0, 3)), np.zeros(0, np.intp), np.zeros(0)
    ),
    [],
)


def solve(stations: Stations, poses: Mapping[int, Pose], settings: RegistrationSettings) -> Solved:
    """Adjust all stations that have starting poses at once.

    Parameters
    ----------
    stations : Stations
    poses : mapping
        From rows to starting poses in the frame of the first row, which stays fixed.
    settings : RegistrationSettings
    """
    rows = list(poses)
    current = dict(poses)
    lost: dict[int, str] = {}
    while True:
        links, solution = _NOTHING, _unmoved(current)
        for _ in range(settings.adjustment.rounds):
            links = _links(stations, rows, current, settings)
            if not len(links.labels):
                break
            middles = np.array([stations.middle(row) for row in rows])
            solution = adjust_network(links.observations, [current[row] for row in rows], 0, settings.adjustment, middles, stations.level[rows])
            current = dict(zip(rows, solution.poses, strict=True))
        leaving = _contradicted(stations, rows, links, solution, settings) or _undetermined(stations, rows, links, solution, settings)
        if not leaving:
            break
        lost |= leaving
        rows = [row for row in rows if row not in leaving]
        current = {row: poses[row] for row in rows}
    pairs = _residuals(stations, rows, links, solution, settings)
    return Solved(tuple(rows), solution, pairs, lost, _remarks(pairs))


def _remarks(pairs: Sequence[PairResidual]) -> tuple[str, ...]:
    """Return a sentence for each control point that does not fit somewhere."""
    worst: dict[str, PairResidual] = {}
    for pair in pairs:
        if pair.kind == CONTROL_POINT and pair.outlier and (pair.id_a not in worst or max(pair.distances) > max(worst[pair.id_a].distances)):
            worst[pair.id_a] = pair
    return tuple(
        f"control point {name} does not fit between {pair.station_a} and {pair.station_b} by {max(pair.distances):.1f} mm and is left out;"
        " check its coordinates"
        for name, pair in worst.items()
    )


def _unmoved(poses: Mapping[int, Pose]) -> NetworkSolution:
    """Return the solution of stations that nothing observes."""
    count, none = len(poses), np.zeros(0)
    return NetworkSolution(tuple(poses.values()), np.zeros((count, 6, 6)), np.zeros((0, 2)), none, none, 1.0, 0, 0, converged=True)


def _links(stations: Stations, rows: Sequence[int], poses: Mapping[int, Pose], settings: RegistrationSettings) -> _Links:
    """Return what all pairs of stations observe at approximate poses."""
    parts, labels = [_NOTHING.observations], []
    for (number, a), (other, b) in itertools.combinations(enumerate(rows), 2):
        a_from_b = poses[a].inverse @ poses[b]
        one, second = stations.landmarks[a], stations.landmarks[b]
        if len(one) and len(second):
            pairs = _with_assigned(explained_pairs(one, second, a_from_b, settings.search), a, b, stations)
            parts.append(observations_of(one, second, pairs, a_from_b, (number, other)))
            here, there = stations.pipelines[a].components, stations.pipelines[b].components
            labels += [(number, here[i].id, other, there[j].id, here[i].kind) for i, j in zip(pairs.first, pairs.second, strict=True)]
        names = stations.common_points(a, b)
        if names:
            points, targets = stations.point_arrays(a, b)
            covariance = np.broadcast_to(2 * np.eye(3) * _control_sigma(stations, settings) ** 2, (len(points), 3, 3))
            parts.append(observations_of_points(points, targets, covariance, (number, other)))
            labels += [(number, name, other, name, CONTROL_POINT) for name in names]
    joined = Observations.joined(parts)
    return _Links(
        Observations(joined.stations.astype(np.intp), *(getattr(joined, name) for name in list(Observations.__dataclass_fields__)[1:])), labels
    )


def _control_sigma(stations: Stations, settings: RegistrationSettings) -> float:
    """Return the standard deviation of a control point's coordinate, mm."""
    return stations.sigma if stations.sigma is not None else settings.adjustment.control_sigma


def _with_assigned(pairs: Pairs, a: int, b: int, stations: Stations) -> Pairs:
    """Return pairs with those that were assigned by hand, which no other of the same components may contradict."""
    assigned = stations.assigned.get((min(a, b), max(a, b)))
    if assigned is None:
        return pairs
    if a > b:
        assigned = Pairs(assigned.second, assigned.first, assigned.rarity)
    kept = pairs[~(np.isin(pairs.first, assigned.first) | np.isin(pairs.second, assigned.second))]
    return Pairs(*(np.concatenate([getattr(part, name) for part in (kept, assigned)]) for name in ("first", "second", "rarity")))


def _contradicted(
    stations: Stations, rows: Sequence[int], links: _Links, solution: NetworkSolution, settings: RegistrationSettings
) -> dict[int, str]:
    """Return the station, by row, whose control points fit least, if too many of them do not, and a sentence."""
    worst: tuple[float, int, list[str]] | None = None
    for number, row in enumerate(rows[1:], 1):
        own = [k for k, label in enumerate(links.labels) if label[4] == CONTROL_POINT and number in {label[0], label[2]}]
        bad = [k for k in own if solution.normalised[k] > settings.adjustment.outlier]
        share = len(bad) / len(own) if own else 0.0
        if share > CONTRADICTING_SHARE and (worst is None or share > worst[0]):
            worst = (share, row, sorted({links.labels[k][1] for k in bad}))
    if worst is None:
        return {}
    _, row, names = worst
    where = "of the known ones" if stations.names[row] == PLANT else f"in {stations.names[row]}"
    return {row: f"the control points {', '.join(names)} {where} contradict the others; check their names and coordinates or leave them out"}


def _undetermined(
    stations: Stations, rows: Sequence[int], links: _Links, solution: NetworkSolution, settings: RegistrationSettings
) -> dict[int, str]:
    """Return the stations, by row, whose poses the pairs do not determine, each with a sentence."""
    limits = settings.adjustment
    lost = {}
    observed = {station for label in links.labels for station in (label[0], label[2])}
    for number, row in enumerate(rows[1:], 1):
        if number not in observed:
            lost[row] = f"{stations.names[row]} has nothing in common with the other stations any more; add components to it that they show, too"
            continue
        position, rotation = solution.sigma_at(number, stations.middle(row))
        if position.max() > limits.slide or np.degrees(rotation.max()) > limits.turn_deg:
            lost[row] = (
                f"{stations.names[row]} has {_what_is_common(links, number, settings)}; add an elbow, a flange or a pipe across to both stations"
            )
    return lost


def _what_is_common(links: _Links, number: int, settings: RegistrationSettings) -> str:
    """Return why what a station has in common with others does not fix its pose."""
    axes = links.observations.axes[(links.observations.stations == number).any(axis=1)]
    lines = axes[np.any(axes, axis=1)]
    parallel = (np.abs(lines @ lines[:1].T) >= np.cos(np.radians(settings.search.crossing_deg))).all()
    if len(lines) == len(axes) and parallel:
        return "only parallel pipes in common with the other stations: they may slide along each other"
    return "too little in common with the other stations to fix its place"


def _residuals(
    stations: Stations, rows: Sequence[int], links: _Links, solution: NetworkSolution, settings: RegistrationSettings
) -> tuple[PairResidual, ...]:
    found = []
    for number, (a, id_a, b, id_b, kind) in enumerate(links.labels):
        both = solution.distances[number]
        normalised = float(solution.normalised[number])
        found.append(
            PairResidual(
                stations.names[rows[a]],
                id_a,
                stations.names[rows[b]],
                id_b,
                kind,
                tuple(round(float(value), 3) for value in (both if kind == "pipe" else both[:1])),
                round(normalised, 2),
                round(float(solution.weights[number]), 3),
                normalised > settings.adjustment.outlier * max(1.0, solution.sigma0),
            )
        )
    return tuple(found)
