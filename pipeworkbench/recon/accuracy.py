# SPDX-License-Identifier: LGPL-2.1-or-later
"""How well something is known, as a level of accuracy."""

from __future__ import annotations

# Level of Accuracy of the U.S. Institute of Building Documentation: upper limits in mm at 95 %
LEVELS_OF_ACCURACY = ((1.0, "LOA50"), (5.0, "LOA40"), (15.0, "LOA30"), (50.0, "LOA20"))
COVERAGE_FACTOR = 2.0  # standard deviations in a 95 % interval


def level_of_accuracy(sigma: float) -> str:
    """Return the USIBD level of accuracy of a position with this standard deviation in mm."""
    return next((name for limit, name in LEVELS_OF_ACCURACY if COVERAGE_FACTOR * sigma <= limit), "LOA10")
