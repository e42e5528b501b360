# SPDX-License-Identifier: LGPL-2.1-or-later
"""Heat flow through insulation against hand calculations, published tables and worked examples, and what must be true of any."""

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from pipeworkbench.errors import InputError
from pipeworkbench.insulation.heat_loss import (
    BARE_EMISSIVITY,
    Surroundings,
    convection_of_pipe,
    convection_of_wall,
    pipe_heat_flow,
    radiation_coefficient,
    wall_heat_flow,
)
from pipeworkbench.insulation.materials import Material, material

ROOM = Surroundings(20.0)

# Heat loss (W/m) of horizontal bare black steel pipes, emissivity 0.9, still air of 20 deg C, by outside diameter (mm) and temperature
# (deg C): roymech.org, "Thermal insulation tables" (the figures of BS 5422, which calculates after EN ISO 12241)
BARE_PIPES = {
    17.2: {50: 23, 100: 78, 150: 150, 300: 491, 700: 3100},
    48.3: {50: 56, 100: 190, 150: 369, 300: 1242, 700: 8292},
    114.3: {50: 119, 100: 405, 150: 791, 300: 2726, 700: 18979},
    219.1: {50: 212, 100: 722, 150: 1419, 300: 4971, 700: 35609},
    273.0: {50: 258, 100: 880, 150: 1731, 300: 6098, 500: 18647, 550: 24221, 600: 30135, 700: 45134},  # turbulent from 550 on
}


@pytest.mark.parametrize(("diameter", "temperature", "loss"), [(d, t, q) for d, row in BARE_PIPES.items() for t, q in row.items()])
def test_bare_pipe_loses_what_the_published_table_says(diameter, temperature, loss):
    found = pipe_heat_flow(diameter, (), temperature, ROOM, 0.9).flow
    assert found == pytest.approx(loss, rel=2e-4, abs=0.55)  # printed in whole watts, with 5.67e-8 for Stefan-Boltzmann's constant


def test_hand_calculation_of_a_bare_pipe():
    # 48.3 mm, 100 deg C in a room of 20 deg C
    d, difference = 0.0483, 80.0
    assert d**3 * difference < 10  # laminar
    convection = 1.25 * math.sqrt(math.sqrt(difference / d))  # 7.97
    radiation = 0.9 * 5.670374419e-8 * (373.15**4 - 293.15**4) / difference  # 7.66
    assert convection == pytest.approx(7.974, abs=0.001)
    assert radiation == pytest.approx(7.657, abs=0.001)
    found = pipe_heat_flow(48.3, (), 100.0, ROOM, 0.9)
    assert found.surface_coefficient == pytest.approx(convection + radiation, rel=1e-12)
    assert found.flow == pytest.approx((convection + radiation) * math.pi * d * difference, rel=1e-12)
    assert found.surface_temperature == 100.0


def test_hand_calculation_of_one_layer_iterated_by_hand():
    # pipe of 114.3 mm at 150 deg C, 60 mm of lambda = 0.035 + 0.00015 theta under a jacket of emissivity 0.13, room of 20 deg C
    inner, outer = 0.1143, 0.2343
    surface = 30.0  # a guess, then by hand: what the layer lets through must leave the surface
    for _ in range(60):
        conductivity = 0.035 + 0.00015 * (150 + surface) / 2
        layer = math.log(outer / inner) / (2 * math.pi * conductivity)
        hot, cold = surface + 273.15, 293.15
        radiation = 0.13 * 5.670374419e-8 * (hot**2 + cold**2) * (hot + cold)
        convection = 1.25 * ((surface - 20) / outer) ** 0.25
        outside = 1 / (math.pi * outer * (radiation + convection))
        flow = (150 - 20) / (layer + outside)
        surface = 20 + flow * outside
    assert outer**3 * (surface - 20) < 10  # laminar
    wool = Material("by hand", ((0.0, 0.035), (100.0, 0.05)))
    found = pipe_heat_flow(114.3, ((wool, 60.0),), 150.0, ROOM, 0.13)
    assert found.flow == pytest.approx(flow, rel=1e-9)
    assert found.surface_temperature == pytest.approx(surface, abs=1e-6)
    assert found.conductivities == pytest.approx((conductivity,), rel=1e-9)
    # the orders of magnitude: about 0.049 W/(m K), 2.3 m K/W in the layer and a tenth of it outside
    assert 45 < flow < 55
    assert 33 < surface < 36


def test_hand_calculation_of_two_layers_with_their_own_mean_temperatures():
    # 168.3 mm at 300 deg C: 50 mm of lambda = 0.04 + 0.0002 theta, 40 mm of 0.035 + 0.00015 theta, h = 8 W/(m2 K), air of 10 deg C
    d1, d2, d3 = 0.1683, 0.2683, 0.3483
    between, surface = 150.0, 30.0
    for _ in range(200):
        first = math.log(d2 / d1) / (2 * math.pi * (0.04 + 0.0002 * (300 + between) / 2))
        second = math.log(d3 / d2) / (2 * math.pi * (0.035 + 0.00015 * (between + surface) / 2))
        outside = 1 / (8 * math.pi * d3)
        flow = 290 / (first + second + outside)
        between, surface = 300 - flow * first, 10 + flow * outside
    layers = ((Material("a", ((0.0, 0.04), (100.0, 0.06))), 50.0), (Material("b", ((0.0, 0.035), (100.0, 0.05))), 40.0))
    found = pipe_heat_flow(168.3, layers, 300.0, Surroundings(10.0, surface_coefficient=8.0))
    assert found.flow == pytest.approx(flow, rel=1e-9)
    assert found.temperatures == pytest.approx((300.0, between, surface), abs=1e-6)


def test_published_example_of_a_water_pipe_with_its_wall_and_both_coefficients():
    # math-gpt.org, "Teräsputkessa virtaa vettä": steel 100/106 mm (17 W/(m K)), 50 mm of foam (0.033), water of 130 deg C (4500 W/(m2 K)),
    # air of -5 deg C (10 W/(m2 K)); answer about 40.2 W/m
    layers = ((Material.constant("steel", 17.0), 3.0), (Material.constant("foam", 0.033), 50.0))
    found = pipe_heat_flow(100.0, layers, 130.0, Surroundings(-5.0, surface_coefficient=10.0), inner=(4500.0, 100.0))
    assert found.flow == pytest.approx(40.2, abs=0.05)


def test_published_example_of_a_steam_pipe():
    # homework.zookal.com, 207239817: steel 50/60 mm (43 W/(m K)), 12 mm of 0.11 W/(m K), 6 m, steam of 150 deg C (500 W/(m2 K)), air of
    # 16 deg C (17 W/(m2 K)); answers 0.1204 K/W and 1.113 kW
    layers = ((Material.constant("steel", 43.0), 5.0), (Material.constant("insulation", 0.11), 12.0))
    found = pipe_heat_flow(50.0, layers, 150.0, Surroundings(16.0, surface_coefficient=17.0), inner=(500.0, 50.0))
    assert 6 * found.flow == pytest.approx(1113.0, rel=2e-3)
    assert 134 / (6 * found.flow) == pytest.approx(0.1204, rel=2e-3)


def test_published_example_of_free_convection_is_met_within_what_simplified_formulas_can():
    # Cengel, "Heat Transfer", example of natural convection: 6 m of 80 mm at 70 deg C in a room of 20 deg C lose 443 W by convection, calculated
    # with Churchill and Chu's correlation; the simplified formula is 6 % above it
    found = convection_of_pipe(80.0, 50.0) * math.pi * 0.08 * 6 * 50
    assert found == pytest.approx(443.0, rel=0.07)


def test_radiation_is_exact_and_four_t_cubed_in_the_limit():
    assert radiation_coefficient(0.8, 100, 20) * 80 == pytest.approx(0.8 * 5.670374419e-8 * (373.15**4 - 293.15**4), rel=1e-12)
    assert radiation_coefficient(1.0, 20, 20) == pytest.approx(4 * 5.670374419e-8 * 293.15**3, rel=1e-12)


def test_convection_of_standing_pipes_and_turbulence():
    assert convection_of_pipe(100.0, 16.0, vertical=True) == pytest.approx(1.32 * (16 / 0.1) ** 0.25)
    assert convection_of_pipe(1000.0, 27.0, vertical=True) == pytest.approx(1.74 * 3)
    assert convection_of_pipe(1000.0, 27.0) == pytest.approx(1.21 * 3)
    assert convection_of_wall(100.0, 16.0) == pytest.approx(1.32 * (16 / 0.1) ** 0.25)
    assert convection_of_wall(1000.0, 64.0) == pytest.approx(1.74 * 4)
    assert convection_of_pipe(100.0, -16.0) == convection_of_pipe(100.0, 16.0)


def test_convection_in_wind():
    assert convection_of_pipe(100.0, 1.0, 4.0) == pytest.approx(8.9 * 4**0.9 / 0.1**0.1)
    assert convection_of_pipe(20.0, 1.0, 0.4) == pytest.approx(8.1e-3 / 0.02 + 3.14 * math.sqrt(0.4 / 0.02))
    assert convection_of_wall(1000.0, 1.0, 4.0) == pytest.approx(3.96 * 2)
    assert convection_of_wall(4000.0, 1.0, 3.0) == pytest.approx(5.76 * (81 / 4) ** 0.2)
    # a breath of wind cools no less than still air
    assert convection_of_pipe(100.0, 50.0, 1e-6) == convection_of_pipe(100.0, 50.0)


def test_plane_wall_by_hand():
    # 100 mm of 0.04 W/(m K), 200 to 20 deg C, h = 10: 180 / (2.5 + 0.1)
    found = wall_heat_flow(500.0, ((Material.constant("x", 0.04), 100.0),), 200.0, Surroundings(20.0, surface_coefficient=10.0))
    assert found.flow == pytest.approx(180 / 2.6)
    assert found.surface_temperature == pytest.approx(20 + 18 / 2.6)


def test_nothing_flows_where_all_is_equally_warm():
    found = pipe_heat_flow(100.0, ((material("mineral wool"), 40.0),), 20.0, ROOM)
    assert found.flow == 0
    assert found.surface_temperature == 20


def test_cold_pipe_takes_heat_up_and_its_surface_stays_between():
    found = pipe_heat_flow(60.3, ((material("elastomeric foam"), 19.0),), 6.0, Surroundings(25.0))
    assert found.flow < 0
    assert 6 < found.surface_temperature < 25


@pytest.mark.parametrize(
    ("arguments", "key"),
    [
        ((0.0, (), 100.0, ROOM), "diameter"),
        ((math.nan, (), 100.0, ROOM), "diameter"),
        ((50.0, ((Material.constant("x", 0.04), -1.0),), 100.0, ROOM), "layers[0].thickness"),
        ((50.0, (), -300.0, ROOM), "medium_temperature"),
        ((50.0, (), math.inf, ROOM), "medium_temperature"),
        ((50.0, (), 50.0, Surroundings(-273.15)), "ambient_temperature"),
    ],
)
def test_impossible_input_is_refused_by_name(arguments, key):
    with pytest.raises(InputError) as error:
        pipe_heat_flow(*arguments)
    assert error.value.key == key


# ---------------------------------------------------------------- what is true of all pipes

diameters = st.floats(15, 600)
temperatures = st.floats(40, 400)


@given(diameter=diameters, thickness=st.floats(5, 200), medium=temperatures, emissivity=st.floats(0.05, 0.95), wind=st.sampled_from([0.0, 0.5, 5.0]))
def test_what_arrives_leaves(diameter, thickness, medium, emissivity, wind):
    surroundings = Surroundings(15.0, wind)
    found = pipe_heat_flow(diameter, ((material("mineral wool"), thickness),), medium, surroundings, emissivity)
    outer = (diameter + 2 * thickness) / 1000
    surface = found.surface_temperature
    assert 15 < surface < medium
    # free convection jumps where it becomes turbulent: there, the temperature is right, and the coefficient one of two
    assume(abs(outer**3 * (surface - 15) - 10) > 1e-6)
    assert found.flow == pytest.approx(found.surface_coefficient * math.pi * outer * (surface - 15), rel=1e-6)
    assert found.conductivities[0] == pytest.approx(float(material("mineral wool").conductivity((medium + surface) / 2)), rel=1e-9)


@given(diameter=st.floats(60, 600), medium=temperatures, thickness=st.floats(10, 150), more=st.floats(1, 100))
def test_more_insulation_loses_less_on_thick_pipes(diameter, medium, thickness, more):
    wool = material("mineral wool")
    losses = [pipe_heat_flow(diameter, ((wool, s),), medium, ROOM, 0.13) for s in (thickness, thickness + more)]
    assert losses[1].flow < losses[0].flow
    assert losses[1].surface_temperature < losses[0].surface_temperature
    assert losses[0].flow < pipe_heat_flow(diameter, (), medium, ROOM, BARE_EMISSIVITY).flow


@given(coefficient=st.floats(4, 12), conductivity=st.floats(0.1, 0.5))
def test_loss_around_a_thin_pipe_is_greatest_at_the_critical_radius(coefficient, conductivity):
    # textbook: r = lambda / h
    critical = conductivity / coefficient * 1000
    diameter = critical  # half of the critical one
    poor = Material.constant("poor", conductivity)
    surroundings = Surroundings(20.0, surface_coefficient=coefficient)
    thickness = critical - diameter / 2
    below, at, above = (pipe_heat_flow(diameter, ((poor, s),), 90.0, surroundings).flow for s in (0.9 * thickness, thickness, 1.1 * thickness))
    assert at > below
    assert at > above
    assert at > pipe_heat_flow(diameter, (), 90.0, surroundings).flow


@given(diameter=diameters, medium=temperatures, first=st.floats(1, 80), second=st.floats(1, 80), conductivity=st.floats(0.02, 0.2))
def test_two_layers_of_one_constant_material_are_one(diameter, medium, first, second, conductivity):
    one = Material.constant("x", conductivity)
    whole = pipe_heat_flow(diameter, ((one, first + second),), medium, ROOM)
    parts = pipe_heat_flow(diameter, ((one, first), (one, second)), medium, ROOM)
    assert parts.flow == pytest.approx(whole.flow, rel=1e-6)
    assert np.all(np.diff(parts.temperatures) < 0)


@given(medium=temperatures, thickness=st.floats(20, 150))
def test_thick_pipe_is_a_wall(medium, thickness):
    wool = ((material("mineral wool"), thickness),)
    surroundings = Surroundings(20.0, surface_coefficient=9.0)
    diameter = 1e7
    pipe, wall = pipe_heat_flow(diameter, wool, medium, surroundings), wall_heat_flow(1000.0, wool, medium, surroundings)
    assert pipe.flow / (math.pi * diameter / 1000) == pytest.approx(wall.flow, rel=1e-4)
