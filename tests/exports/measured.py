# SPDX-License-Identifier: LGPL-2.1-or-later
"""A measured pipe with all that is known of one, for the tests of what is written about it."""

from pipeworkbench.pipeline import Pipe

DN40 = Pipe(
    id="A-P00",
    start=(100.0, 3600.0, -50.0),
    end=(400.0, 3600.0, 350.0),
    outer_diameter=48.3,
    wall_thickness=2.6,
    dn=40,
    standard="EN 10220",
    pick=0,
    station="A",
    quality=0.2134,
    sigma_position=(0.02, 0.12, 0.03),
    sigma_direction_deg=0.015,
    sigma_outer_diameter=0.11,
    loa="LOA50",
    verified=2,
)
