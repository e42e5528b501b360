# SPDX-License-Identifier: LGPL-2.1-or-later
"""What components and whole pipelines lose in a year, against hand calculations; sums, savings, what is not known."""

import math
from dataclasses import replace

import pytest

from pipeworkbench.errors import InputError
from pipeworkbench.insulation.component_loss import HEAD_AREA, component_loss, equivalent_length
from pipeworkbench.insulation.energy import compare, energy_of, energy_of_components
from pipeworkbench.insulation.heat_loss import Surroundings, pipe_heat_flow, wall_heat_flow
from pipeworkbench.insulation.materials import material
from pipeworkbench.insulation.operation import Operation
from pipeworkbench.insulation.specification import SCHEMA, Specification
from pipeworkbench.insulation.treatment import Flanges, Treatment
from pipeworkbench.pipeline import Cap, Elbow, Flange, Pipe, Pipeline, Reducer, Tee
from pipeworkbench.solids.coverings import Layer, Sheet

HOT = Operation(medium_temperature=150.0, hours_per_year=8000.0, price_per_kwh=0.1, kg_co2_per_kwh=0.2, efficiency=0.8)
TREATMENT = Treatment((Layer("mineral wool", 60.0),), Sheet("aluminium", 0.6))
PIPE = Pipe(id="P1", start=(0, 0, 0), end=(2500, 0, 0), outer_diameter=114.3)
FLANGE = Flange(
    id="F1", face=(0, 0, 0), axis=(1, 0, 0), flange_type="11", pn=16, D=220.0, C=20.0, length=52.0, neck_diameter=131.0, outer_diameter=114.3
)  # fmt: skip
WOOL = ((material("mineral wool"), 60.0),)
ROOM = Surroundings(20.0)


def per_metre(diameter, *, insulated, vertical=False):
    return pipe_heat_flow(diameter, WOOL if insulated else (), 150.0, ROOM, 0.13 if insulated else 0.9, vertical=vertical).flow


# ---------------------------------------------------------------- components


def test_pipe_loses_its_length_at_the_loss_per_metre():
    assert component_loss(PIPE, TREATMENT, HOT).heat == pytest.approx(2.5 * per_metre(114.3, insulated=True))
    assert component_loss(PIPE, None, HOT).heat == pytest.approx(2.5 * per_metre(114.3, insulated=False))
    assert component_loss(PIPE, None, HOT).heat == pytest.approx(2.5 * 791, rel=1e-3)  # the published table of bare pipes


def test_standing_pipe_loses_by_the_formula_for_standing_pipes():
    standing = replace(PIPE, end=(0.0, 0.0, 2500.0))
    assert component_loss(standing, None, HOT).heat == pytest.approx(2.5 * per_metre(114.3, insulated=False, vertical=True))
    assert component_loss(standing, None, HOT).heat > component_loss(PIPE, None, HOT).heat


def test_elbow_loses_as_a_pipe_as_long_as_its_axis():
    elbow = Elbow(id="E", start=(0, 0, 0), end=(152, 152, 0), intersection=(152, 0, 0), angle_deg=90, bend_radius=152, outer_diameter=114.3)
    assert component_loss(elbow, TREATMENT, HOT).heat == pytest.approx(math.pi / 2 * 0.152 * per_metre(114.3, insulated=True))


def test_reducer_loses_as_a_pipe_of_the_mean_diameter():
    reducer = Reducer(id="R", start=(0, 0, 0), end=(102, 0, 0), axis=(1, 0, 0), outer_diameter=114.3, end_diameter=60.3)
    assert component_loss(reducer, TREATMENT, HOT).heat == pytest.approx(0.102 * per_metre(87.3, insulated=True))


def test_tee_loses_run_and_branch_from_the_runs_outside_on():
    tee = Tee(
        id="T", start=(-100, 0, 0), end=(100, 0, 0), intersection=(0, 0, 0), branch_end=(0, 97.15, 0), outer_diameter=114.3, branch_diameter=60.3
    )
    found = component_loss(tee, TREATMENT, HOT)
    assert found.heat == pytest.approx(0.2 * per_metre(114.3, insulated=True) + 0.04 * per_metre(60.3, insulated=True))
    assert found.length == pytest.approx(0.24)


def test_cap_loses_through_mantle_and_flat_end_and_bare_through_its_head():
    cap = Cap(id="C", start=(0, 0, 0), axis=(1, 0, 0), length=64.0, outer_diameter=114.3)
    end = wall_heat_flow(114.3, WOOL, 150.0, ROOM, 0.13).flow * math.pi * 0.1143**2 / 4
    assert component_loss(cap, TREATMENT, HOT).heat == pytest.approx(0.064 * per_metre(114.3, insulated=True) + end)
    # a 2 : 1 head has 1.084 d^2, commonly quoted
    assert HEAD_AREA * math.pi / 4 == pytest.approx(1.084, abs=5e-4)
    area = math.pi * 0.1143 * (0.064 - 0.1143 / 4) + 1.084 * 0.1143**2
    assert component_loss(cap, None, HOT).heat == pytest.approx(area * per_metre(114.3, insulated=False) / (math.pi * 0.1143), rel=1e-3)


def test_bare_flange_loses_by_its_rim_back_and_neck():
    rim, back = math.pi * 0.22 * 0.02, math.pi / 4 * (0.22**2 - 0.131**2)
    neck = math.pi * (0.131 + 0.1143) / 2 * math.hypot(0.032, (0.131 - 0.1143) / 2)
    flux = per_metre(220.0, insulated=False) / (math.pi * 0.22)
    assert component_loss(FLANGE, None, HOT).heat == pytest.approx((rim + back + neck) * flux)
    # more than twice what the pipe of its length loses
    assert component_loss(FLANGE, None, HOT).heat > 2 * 0.052 * per_metre(114.3, insulated=False)


def test_bare_flange_is_worth_metres_of_its_insulated_pipe():
    found = equivalent_length(FLANGE, TREATMENT, HOT)
    assert found == pytest.approx(component_loss(FLANGE, None, HOT).heat / per_metre(114.3, insulated=True))
    assert 1 < found < 5
    assert math.isinf(equivalent_length(FLANGE, TREATMENT, replace(HOT, medium_temperature=20.0)))


def test_flange_in_a_box_loses_through_mantle_and_end():
    mantle = 0.052 * per_metre(260.0, insulated=True)
    end = wall_heat_flow(260.0, WOOL, 150.0, ROOM, 0.13).flow * math.pi / 4 * (0.26**2 - 0.1143**2)
    assert component_loss(FLANGE, TREATMENT, HOT).heat == pytest.approx(mantle + end)


def test_flange_that_is_left_bare_loses_as_without_treatment():
    bare = replace(TREATMENT, flanges=Flanges(cover="bare"))
    assert component_loss(FLANGE, bare, HOT) == component_loss(FLANGE, None, HOT)
    assert component_loss(PIPE, bare, HOT) == component_loss(PIPE, TREATMENT, HOT)


def test_blind_flange_loses_over_its_whole_plate():
    blind = replace(FLANGE, flange_type="05", neck_diameter=None, length=20.0)
    area = math.pi * 0.22 * 0.02 + math.pi / 4 * 0.22**2
    assert component_loss(blind, None, HOT).heat == pytest.approx(area * per_metre(220.0, insulated=False) / (math.pi * 0.22))
    assert component_loss(blind, TREATMENT, HOT).heat > component_loss(replace(FLANGE, length=20.0), TREATMENT, HOT).heat


def test_jacket_that_shines_keeps_more_heat_and_gets_hotter():
    dull, bright = (component_loss(PIPE, replace(TREATMENT, jacket=sheet), HOT) for sheet in (None, Sheet("aluminium", 0.6)))
    assert bright.heat < dull.heat
    assert bright.surface_temperature > dull.surface_temperature


# ---------------------------------------------------------------- a year


def test_year_by_hand():
    (row,) = energy_of_components([(PIPE, TREATMENT, HOT)]).rows
    # W / 1000 x 8000 h / 0.8, then 0.1 and 0.2 for each kWh
    assert row.bare.energy == pytest.approx(2.5 * per_metre(114.3, insulated=False) * 10)
    assert row.insulated.energy == pytest.approx(2.5 * per_metre(114.3, insulated=True) * 10)
    assert row.bare.cost == pytest.approx(row.bare.energy / 10)
    assert row.bare.co2 == pytest.approx(row.bare.energy / 5)
    assert row.saved.energy == pytest.approx(row.bare.energy - row.insulated.energy)
    assert row.saved.cost == pytest.approx(row.saved.energy / 10)
    assert (row.component, row.kind, row.length, row.thickness, row.currency) == ("P1", "pipe", 2.5, 60.0, "EUR")
    assert row.bare_surface_temperature == 150
    assert 30 < row.surface_temperature < 40


def test_whole_pipeline_is_the_sum_of_its_parts(everything):
    specification = Specification.from_dict(
        {
            "schema": SCHEMA,
            "operation": {"medium_temperature": 130, "price_per_kwh": 0.1, "kg_co2_per_kwh": 0.2},
            "default": {"layers": [{"material": "mineral wool", "thickness": 40}]},
            "rules": [{"match": {"kinds": ["cap"]}, "bare": True}, {"match": {"kinds": ["elbow"]}, "operation": {"medium_temperature": 90}}],
        }
    )
    energy = energy_of(everything, specification)
    assert [row.component for row in energy.rows] == [component.id for component in everything.components]
    assert {row.run for row in energy.rows} == {"R1"}
    for part in ("heat", "energy", "cost", "co2"):
        assert getattr(energy.bare, part) == pytest.approx(sum(getattr(row.bare, part) for row in energy.rows))
        assert getattr(energy.saved, part) == pytest.approx(sum(getattr(row.saved, part) for row in energy.rows))
    for row in energy.rows:
        assert row.medium_temperature == (90 if row.kind == "elbow" else 130)
        if row.kind == "cap":
            assert row.insulated == row.bare
            assert row.thickness == 0
        else:
            assert row.insulated.heat < row.bare.heat
    assert energy.remarks == ("jacket 0.6 mm of aluminium after DIN 4140 (not verified against the standard)",)


def test_what_does_this_pipe_lose_now_and_with_60_mm():
    now, with_30, with_60 = compare(PIPE, HOT, [None, replace(TREATMENT, layers=(Layer("mineral wool", 30.0),)), TREATMENT])
    assert now.insulated == now.bare
    assert now.saved.energy == 0
    assert with_60.insulated.heat < with_30.insulated.heat < now.bare.heat
    assert with_60.bare == now.bare
    assert with_60.insulated.heat == pytest.approx(2.5 * per_metre(114.3, insulated=True))


def test_costs_that_are_not_known_are_none_and_sums_too():
    unknown = replace(HOT, price_per_kwh=None, kg_co2_per_kwh=None)
    energy = energy_of_components([(PIPE, TREATMENT, HOT), (replace(PIPE, id="P2"), TREATMENT, unknown)])
    assert energy.rows[1].bare.cost is None
    assert energy.rows[1].saved.co2 is None
    assert energy.bare.cost is None
    assert energy.saved.cost is None
    assert energy.bare.energy == pytest.approx(2 * energy.rows[0].bare.energy)


def test_cold_pipe_costs_what_it_takes_up():
    cold = replace(HOT, medium_temperature=6.0, ambient_temperature=26.0)
    (row,) = energy_of_components([(PIPE, replace(TREATMENT, layers=(Layer("elastomeric foam", 19.0),)), cold)]).rows
    assert row.bare.heat < row.insulated.heat < 0
    assert row.bare.energy > row.insulated.energy > 0
    assert row.saved.energy > 0


def test_missing_temperature_is_refused_by_component():
    with pytest.raises(InputError, match=r"P1: operation\.medium_temperature: is missing"):
        energy_of(Pipeline(frame="A", components=(PIPE,)), Specification.uniform(50))


def test_nothing_loses_nothing():
    energy = energy_of(Pipeline(frame="A"), Specification.uniform(50))
    assert energy.rows == ()
    assert (energy.bare.heat, energy.bare.energy, energy.bare.cost) == (0, 0, 0)
