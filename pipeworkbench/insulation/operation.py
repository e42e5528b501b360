# SPDX-License-Identifier: LGPL-2.1-or-later
"""In what service pipework is: temperatures, wind, hours of operation, and what the heat costs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from annotated_types import Ge, Gt, Le

from pipeworkbench.insulation.heat_loss import ABSOLUTE_ZERO, BARE_EMISSIVITY, Surroundings
from pipeworkbench.pipeline import Finite, NotNegative

HOURS_OF_A_YEAR = 8760.0
STRONGEST_WIND = 100.0  # m/s; what is more was not given in m/s

HOTTEST = 2000.0  # deg C; no insulation stands more

Temperature = Annotated[Finite, Gt(ABSOLUTE_ZERO), Le(HOTTEST)]


@dataclass(frozen=True, kw_only=True)
class Operation:
    """In what service a component is.

    Temperatures are deg C, ``wind_speed`` m/s (0 indoors). ``efficiency`` is the heat delivered to the pipework over the energy
    bought: ``price_per_kwh`` (in ``currency``) and ``kg_co2_per_kwh`` are those of the energy bought. What is None is not known,
    and what would follow from it is not told. ``bare_emissivity`` is that of the pipe's own surface.
    """

    medium_temperature: Temperature | None = None
    ambient_temperature: Temperature = 20.0
    wind_speed: Annotated[NotNegative, Le(STRONGEST_WIND)] = 0.0
    hours_per_year: Annotated[NotNegative, Le(HOURS_OF_A_YEAR)] = HOURS_OF_A_YEAR
    price_per_kwh: NotNegative | None = None
    kg_co2_per_kwh: NotNegative | None = None
    efficiency: Annotated[Finite, Gt(0)] = 1.0
    bare_emissivity: Annotated[Finite, Ge(0), Le(1)] = BARE_EMISSIVITY
    currency: str = "EUR"

    @property
    def surroundings(self) -> Surroundings:
        """What is around the insulation."""
        return Surroundings(self.ambient_temperature, self.wind_speed)
