# SPDX-License-Identifier: LGPL-2.1-or-later
"""What heat a component loses, bare and insulated.

================ ==================================================================================================
component        taken for
================ ==================================================================================================
pipe, elbow      the length of its axis, at a straight pipe's loss per metre
reducer          its length, of a pipe of the mean of both diameters
tee              the run's length, and the branch's from the run's outside on
cap              insulated a cylinder and a flat end; bare a cylinder and an ellipsoidal head
flange           in a box the box's mantle as long as the flange, and its end around the pipe: the box's hollow counts as
                 warm as the medium; bare its rim, its back and its neck, each square metre losing what a pipe of the rim's
                 diameter loses; its sealing face loses nothing (a blind flange's loses too, as its cover is open to the air)
================ ==================================================================================================

Valves are no components: what a body between two flanges loses is not counted. Supports and other bridges are not counted either.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from pipeworkbench.errors import InputError
from pipeworkbench.insulation.heat_loss import Layers, pipe_heat_flow, wall_heat_flow
from pipeworkbench.insulation.operation import Operation
from pipeworkbench.insulation.specification import is_vertical, layers_of, outer_emissivity
from pipeworkbench.insulation.treatment import Treatment
from pipeworkbench.pipeline import BLIND_FLANGE, AnyComponent, Cap, Elbow, Flange, Pipe, Reducer, Tee
from pipeworkbench.solids.outlines import dish_height

MM = 1e-3  # m
# area of a half ellipsoid of axes 2 : 1 over that of its circle: 1 + (1 - e^2) / e artanh e, with e^2 = 3 / 4
HEAD_AREA = 1 + 0.25 / math.sqrt(0.75) * math.atanh(math.sqrt(0.75))


@dataclass(frozen=True)
class ComponentLoss:
    """What a component loses: ``heat`` in W (negative into a cold one), its ``surface_temperature`` (deg C), its ``length`` (m).

    The surface is the mantle's; the length is that of the axis, of a flange that from its face to the weld end.
    """

    heat: float
    surface_temperature: float
    length: float


@dataclass(frozen=True)
class _Surface:
    """The insulation and the service that all parts of one component share."""

    layers: Layers
    medium: float
    operation: Operation
    emissivity: float
    vertical: bool

    def of_pipe(self, diameter: float, length: float) -> tuple[float, float]:
        """Return the loss (W) and the surface temperature (deg C) of a length (mm) of pipe."""
        surroundings = self.operation.surroundings
        found = pipe_heat_flow(diameter, self.layers, self.medium, surroundings, self.emissivity, vertical=self.vertical)
        return found.flow * length * MM, found.surface_temperature

    def of_wall(self, height: float, area: float) -> float:
        """Return the loss (W) of an area (mm2) of plane wall."""
        return wall_heat_flow(height, self.layers, self.medium, self.operation.surroundings, self.emissivity).flow * area * MM**2


def component_loss(component: AnyComponent, treatment: Treatment | None, operation: Operation) -> ComponentLoss:
    """Return what a component loses.

    Parameters
    ----------
    component : Component
    treatment : Treatment or None
        None where it is bare; a flange is bare where the treatment leaves flanges bare.
    operation : Operation

    Raises
    ------
    InputError
        Where the medium's temperature is not given, or a material is not in the tables.
    """
    bare = treatment is None or (isinstance(component, Flange) and treatment.flanges.cover == "bare")
    surface = _surface(None if bare else treatment, operation, component)
    match component:
        case Pipe() | Elbow():
            heat, temperature = surface.of_pipe(component.outer_diameter, component.length)
        case Reducer():
            heat, temperature = surface.of_pipe((component.outer_diameter + component.end_diameter) / 2, component.length)
        case Tee():
            return _tee(component, surface)
        case Cap():
            return _cap(component, surface)
        case Flange():
            return _bare_flange(component, surface) if bare or treatment is None else _flange_box(component, surface, treatment.flanges.clearance)
    return ComponentLoss(heat, temperature, component.length * MM)


def equivalent_length(flange: Flange, treatment: Treatment, operation: Operation) -> float:
    """Return how many metres of its pipe, insulated so, lose as much as the bare flange; infinite where these lose nothing.

    The same kind of figure as the equivalent lengths that VDI 2055 and EN ISO 12241 tabulate, but from the flange's own surface.
    """
    surface = _surface(treatment, operation, flange)
    per_metre, _ = surface.of_pipe(flange.outer_diameter, 1 / MM)
    return component_loss(flange, None, operation).heat / per_metre if per_metre else math.inf


def _surface(treatment: Treatment | None, operation: Operation, component: AnyComponent) -> _Surface:
    if operation.medium_temperature is None:
        raise InputError(component.id, "operation.medium_temperature", "is missing", "give the medium's temperature in deg C")
    layers = () if treatment is None else layers_of(treatment.layers)
    return _Surface(layers, operation.medium_temperature, operation, _emissivity(treatment, operation), is_vertical(component))


def _emissivity(treatment: Treatment | None, operation: Operation) -> float:
    if treatment is None:
        return operation.bare_emissivity
    return outer_emissivity(treatment.jacket.material if treatment.jacket else None)


def _tee(tee: Tee, surface: _Surface) -> ComponentLoss:
    run, temperature = surface.of_pipe(tee.outer_diameter, tee.length)
    reach = max(math.dist(tee.intersection, tee.branch_end) - tee.outer_diameter / 2, 0.0)
    branch, _ = surface.of_pipe(tee.branch_diameter, reach)
    return ComponentLoss(run + branch, temperature, (tee.length + reach) * MM)


def _cap(cap: Cap, surface: _Surface) -> ComponentLoss:
    circle = math.pi * cap.outer_diameter**2 / 4
    if surface.layers:
        mantle, temperature = surface.of_pipe(cap.outer_diameter, cap.length)
        return ComponentLoss(mantle + surface.of_wall(cap.outer_diameter, circle), temperature, cap.length * MM)
    straight = cap.length - dish_height(cap)
    # a length of pipe with as much surface as the head
    heat, temperature = surface.of_pipe(cap.outer_diameter, straight + HEAD_AREA * circle / (math.pi * cap.outer_diameter))
    return ComponentLoss(heat, temperature, cap.length * MM)


def _flange_box(flange: Flange, surface: _Surface, clearance: float) -> ComponentLoss:
    hollow = flange.D + 2 * clearance
    mantle, temperature = surface.of_pipe(hollow, flange.length)
    opening = 0.0 if flange.flange_type == BLIND_FLANGE else flange.outer_diameter
    end = surface.of_wall(hollow, math.pi / 4 * (hollow**2 - opening**2))
    return ComponentLoss(mantle + end, temperature, flange.length * MM)


def _bare_flange(flange: Flange, surface: _Surface) -> ComponentLoss:
    """Count its surface as so much length of a pipe as wide as its rim."""
    rim = math.pi * flange.D * flange.C
    plate = math.pi / 4 * flange.D**2
    if flange.flange_type == BLIND_FLANGE:
        area = rim + plate
    else:
        neck = max(min(flange.neck_diameter or flange.outer_diameter, flange.D), flange.outer_diameter)
        cone = math.pi * (neck + flange.outer_diameter) / 2 * math.hypot(flange.length - flange.C, (neck - flange.outer_diameter) / 2)
        area = rim + plate - math.pi / 4 * neck**2 + cone
    heat, temperature = surface.of_pipe(flange.D, area / (math.pi * flange.D))
    return ComponentLoss(heat, temperature, flange.length * MM)
