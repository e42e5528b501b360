# SPDX-License-Identifier: LGPL-2.1-or-later
"""Steady heat flow through insulation, after EN ISO 12241 and VDI 2055-1.

One row of resistances from the medium to the surroundings: the medium's side (left out where it is not given), each layer with
the thermal conductivity at its own mean temperature, the outer surface. Per metre of a pipe, with lengths in m,

    q = (theta_i - theta_a) / (1 / (pi d_i h_i) + sum ln(d_k+1 / d_k) / (2 pi lambda_k) + 1 / (pi d_e h_e))    W/m

and per square metre of a plane wall

    q = (theta_i - theta_a) / (1 / h_i + sum s_k / lambda_k + 1 / h_e)    W/m2.

The pipe's own wall is left out (steel conducts a thousand times better than insulation), the jacket's likewise; both can be given
as layers. The outer coefficient h_e is that of radiation and convection (`surface_coefficient`) and depends on the surface's
temperature, which is found by Brent's method between the medium's and the air's. The layers' conductivities are iterated inside.
"""

from __future__ import annotations

import functools
import itertools
import math
from collections.abc import Callable
from dataclasses import dataclass

from pipeworkbench.errors import InputError
from pipeworkbench.insulation.materials import Material

STEFAN_BOLTZMANN = 5.670374419e-8  # W/(m2 K4), CODATA 2018
ABSOLUTE_ZERO = -273.15  # deg C
TURBULENT = 10.0  # m3 K; D^3 times the temperature difference above which free convection is turbulent
TURBULENT_WIND = 8.55e-3  # m2/s; wind speed times a pipe's diameter
TURBULENT_WIND_WALL = 8.0  # m2/s; wind speed times a wall's height
BARE_EMISSIVITY = 0.9  # of black (oxidised or painted) steel, as of the table of bare pipes the formulas were tested with
TEMPERATURE_TOLERANCE = 1e-9  # K
LAYER_ITERATIONS = 100
MM = 1e-3  # m

Layers = tuple[tuple[Material, float], ...]


@dataclass(frozen=True)
class Surroundings:
    """What is around the insulation.

    ``temperature`` (deg C) of the air and of what the surface radiates to; ``wind_speed`` (m/s), 0 indoors;
    ``surface_coefficient`` (W/(m2 K)) in place of the calculated one.
    """

    temperature: float = 20.0
    wind_speed: float = 0.0
    surface_coefficient: float | None = None


@dataclass(frozen=True)
class HeatFlow:
    """What flows and how warm it gets.

    ``flow`` is in W/m of a pipe or W/m2 of a wall, negative into a cold one; ``temperatures`` (deg C) are those of the layers'
    faces from the innermost to the surface; ``conductivities`` (W/(m K)) those of the layers at their mean temperatures;
    ``surface_coefficient`` (W/(m2 K)) is the outer one.
    """

    flow: float
    temperatures: tuple[float, ...]
    conductivities: tuple[float, ...]
    surface_coefficient: float

    @property
    def surface_temperature(self) -> float:
        """Temperature (deg C) of the outer surface."""
        return self.temperatures[-1]


def radiation_coefficient(emissivity: float, surface: float, ambient: float) -> float:
    """Return the coefficient of radiation (W/(m2 K)) between a surface and its surroundings (deg C), without approximation.

    h_r = epsilon sigma (T_s^4 - T_a^4) / (T_s - T_a) = epsilon sigma (T_s^2 + T_a^2) (T_s + T_a).
    """
    s, a = surface - ABSOLUTE_ZERO, ambient - ABSOLUTE_ZERO
    return emissivity * STEFAN_BOLTZMANN * (s * s + a * a) * (s + a)


def convection_of_pipe(diameter: float, difference: float, wind_speed: float = 0.0, *, vertical: bool = False) -> float:
    """Return the coefficient of convection (W/(m2 K)) on the outside of a pipe.

    The simplified formulas as they are commonly quoted from EN ISO 12241, with the difference D of temperatures (K):

    ================================  ============================  ===========================
    pipe                              laminar                       turbulent
    ================================  ============================  ===========================
    vertical, free                    1.32 (D / d)^0.25             1.74 D^(1/3)
    horizontal, free                  1.25 (D / d)^0.25             1.21 D^(1/3)
    in wind of v m/s                  8.1e-3 / d + 3.14 (v/d)^0.5   8.9 v^0.9 / d^0.1
    ================================  ============================  ===========================

    Free convection is turbulent where d^3 D > 10 m3 K, wind where v d > 8.55e-3 m2/s. Of free convection and wind the larger
    is taken: a breath of wind does not cool less than still air.

    Parameters
    ----------
    diameter : float
        Outer diameter in mm.
    difference : float
        Temperature of the surface less that of the air, K; its sign is left aside.
    wind_speed : float, optional
        In m/s.
    vertical : bool, optional
    """
    d, difference = diameter * MM, abs(difference)
    laminar, turbulent = (1.32, 1.74) if vertical else (1.25, 1.21)
    free = laminar * (difference / d) ** 0.25 if d**3 * difference <= TURBULENT else turbulent * difference ** (1 / 3)
    if not wind_speed:
        return free
    forced = 8.1e-3 / d + 3.14 * math.sqrt(wind_speed / d) if wind_speed * d <= TURBULENT_WIND else 8.9 * wind_speed**0.9 / d**0.1
    return max(free, forced)


def convection_of_wall(height: float, difference: float, wind_speed: float = 0.0) -> float:
    """Return the coefficient of convection (W/(m2 K)) on an upright plane wall.

    As commonly quoted from EN ISO 12241: free 1.32 (D / H)^0.25, where H^3 D > 10 m3 K 1.74 D^(1/3); in wind
    3.96 (v / H)^0.5, where v H > 8 m2/s 5.76 (v^4 / H)^0.2; the larger of both. H is the height, here in mm.
    """
    h, difference = height * MM, abs(difference)
    free = 1.32 * (difference / h) ** 0.25 if h**3 * difference <= TURBULENT else 1.74 * difference ** (1 / 3)
    if not wind_speed:
        return free
    forced = 3.96 * math.sqrt(wind_speed / h) if wind_speed * h <= TURBULENT_WIND_WALL else 5.76 * (wind_speed**4 / h) ** 0.2
    return max(free, forced)


@functools.lru_cache(maxsize=4096)
def pipe_heat_flow(
    diameter: float,
    layers: Layers,
    medium: float,
    surroundings: Surroundings,
    emissivity: float = BARE_EMISSIVITY,
    *,
    vertical: bool = False,
    inner: tuple[float, float] | None = None,
) -> HeatFlow:
    """Return the heat flow per metre of a pipe.

    Parameters
    ----------
    diameter : float
        Of the pipe's outside (where the first layer begins), mm.
    layers : tuple of (Material, float)
        From inside outwards, with their thicknesses in mm; empty for a bare pipe.
    medium : float
        Temperature of the medium in deg C.
    surroundings : Surroundings
    emissivity : float, optional
        Of the outer surface.
    vertical : bool, optional
        Whether the pipe stands rather than lies.
    inner : (float, float), optional
        Coefficient (W/(m2 K)) on the medium's side and the diameter (mm) it belongs to; without it the innermost face is as
        warm as the medium.

    Returns
    -------
    HeatFlow
        Per metre.

    Raises
    ------
    InputError
        For dimensions that are not positive and temperatures below absolute zero.
    """
    _refuse_impossible(diameter, layers, medium, surroundings)
    faces = [diameter]
    for _, thickness in layers:
        faces.append(faces[-1] + 2 * thickness)
    factors = tuple(math.log(outer / here) / (2 * math.pi) for here, outer in itertools.pairwise(faces))
    convection = functools.partial(convection_of_pipe, faces[-1], wind_speed=surroundings.wind_speed, vertical=vertical)
    inside = 1 / (inner[0] * math.pi * inner[1] * MM) if inner else 0.0
    return _solved(factors, layers, math.pi * faces[-1] * MM, inside, medium, surroundings, emissivity, convection)


@functools.lru_cache(maxsize=4096)
def wall_heat_flow(height: float, layers: Layers, medium: float, surroundings: Surroundings, emissivity: float = BARE_EMISSIVITY) -> HeatFlow:
    """Return the heat flow per square metre of an upright plane wall, such as the end of a box; ``height`` in mm, the rest as of pipes."""
    _refuse_impossible(height, layers, medium, surroundings)
    factors = tuple(thickness * MM for _, thickness in layers)
    convection = functools.partial(convection_of_wall, height, wind_speed=surroundings.wind_speed)
    return _solved(factors, layers, 1.0, 0.0, medium, surroundings, emissivity, convection)


def _refuse_impossible(size: float, layers: Layers, medium: float, surroundings: Surroundings) -> None:
    if not size > 0:
        raise InputError("heat loss", "diameter", f"is {size:g} mm", "give a positive length")
    for number, (material, thickness) in enumerate(layers):
        if not thickness >= 0:
            raise InputError("heat loss", f"layers[{number}].thickness", f"of {material.name} is {thickness:g} mm", "give 0 or more")
    for key, temperature in (("medium_temperature", medium), ("ambient_temperature", surroundings.temperature)):
        if not ABSOLUTE_ZERO < temperature < math.inf:
            raise InputError("heat loss", key, f"is {temperature:g} deg C", "give a temperature above absolute zero in deg C")


def _solved(
    factors: tuple[float, ...],
    layers: Layers,
    area: float,
    inside: float,
    medium: float,
    surroundings: Surroundings,
    emissivity: float,
    convection: Callable[[float], float],
) -> HeatFlow:
    """Find the surface temperature at which as much arrives as is given off.

    ``factors`` are the layers' resistances times their conductivities, ``area`` the surface (m2 per metre or per m2),
    ``inside`` the resistance of the medium's side.
    """
    from scipy.optimize import brentq

    ambient = surroundings.temperature

    def coefficient(surface: float) -> float:
        if surroundings.surface_coefficient is not None:
            return surroundings.surface_coefficient
        return radiation_coefficient(emissivity, surface, ambient) + convection(surface - ambient)

    def excess(surface: float) -> float:
        return _conducted(factors, layers, inside, medium, surface)[0] - area * coefficient(surface) * (surface - ambient)

    if not any(factors) and not inside:
        flow = area * coefficient(medium) * (medium - ambient)
        return HeatFlow(flow, (medium,) * (len(layers) + 1), tuple(m.conductivity_at(medium) for m, _ in layers), coefficient(medium))
    surface = medium if medium == ambient else float(brentq(excess, ambient, medium, xtol=TEMPERATURE_TOLERANCE))
    flow, temperatures, conductivities = _conducted(factors, layers, inside, medium, surface)
    return HeatFlow(flow, temperatures, conductivities, coefficient(surface))


def _conducted(
    factors: tuple[float, ...], layers: Layers, inside: float, medium: float, surface: float
) -> tuple[float, tuple[float, ...], tuple[float, ...]]:
    """Return the flow from the medium to the surface, the faces' temperatures and the layers' conductivities.

    The conductivities depend on the temperatures between the layers and these on them: iterated from one mean temperature for all.
    """
    means = [(medium + surface) / 2] * len(layers)
    for _ in range(LAYER_ITERATIONS):
        conductivities = tuple(material.conductivity_at(mean) for (material, _), mean in zip(layers, means, strict=True))
        resistances = [factor / conductivity for factor, conductivity in zip(factors, conductivities, strict=True)]
        flow = (medium - surface) / (inside + sum(resistances))
        temperatures = [medium - flow * inside]
        for resistance in resistances:
            temperatures.append(temperatures[-1] - flow * resistance)
        before, means = means, [(warm + cold) / 2 for warm, cold in itertools.pairwise(temperatures)]
        if max((abs(a - b) for a, b in zip(before, means, strict=True)), default=0.0) < TEMPERATURE_TOLERANCE:
            break
    return flow, tuple(temperatures), conductivities
