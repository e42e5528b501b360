# SPDX-License-Identifier: LGPL-2.1-or-later
"""The made-up plants of the registration's benchmark are what they say."""

import numpy as np
import pytest
import register as bench

from pipeworkbench.pipeline import Elbow, Pipe, Pipeline
from pipeworkbench.recon.topology import joined


@pytest.mark.parametrize("seed", range(3))
def test_made_up_plants_hang_together(seed):
    plant = bench.plant_of(np.random.default_rng(seed), 40)
    assert len(plant) == 40
    assert len({component.id for component in plant}) == 40
    joints = joined(Pipeline(frame="plant", components=tuple(plant))).joints
    ends = {(joint.a, joint.a_port) for joint in joints} | {(joint.b, joint.b_port) for joint in joints}
    # an elbow in the middle of a run is joined on both sides; the last run may have been cut
    elbows = [component for component in plant if isinstance(component, Elbow)]
    assert sum((elbow.id, 0) in ends for elbow in elbows) == len(elbows)
    assert {component.outer_diameter for component in plant} <= set(bench.DIAMETERS)


def test_pipes_are_as_far_off_as_table_4_says():
    rng, off, turned = np.random.default_rng(1), [], []
    true = Pipe(id="P", start=(0.0, 0.0, 0.0), end=(1000.0, 0.0, 0.0), outer_diameter=60.3)
    for _ in range(400):
        made = bench.noisy_pipe(rng, true, [True, True])
        off.append(np.linalg.norm((np.add(made.start, made.end) / 2)[1:]))
        turned.append(np.degrees(np.arctan2(np.linalg.norm(np.subtract(made.end, made.start)[1:]), 1000)))
    assert np.mean(off) == pytest.approx(np.mean([row[0] for row in bench.TABLE_4]), abs=0.06)
    assert np.mean(turned) == pytest.approx(np.mean([row[1] for row in bench.TABLE_4]), abs=0.03)


def test_two_stations_of_the_simulation_are_judged():
    outcome = bench.two_stations(np.random.default_rng([1, 0]))
    assert outcome.right
    assert not outcome.wrong
    assert outcome.deviation < outcome.far < 50
