# SPDX-License-Identifier: LGPL-2.1-or-later
"""Shading across pipes: the medians that leave out what is not in the image."""

import numpy as np

from pipeworkbench.recon.appearance import _median


def test_median_of_what_is_known_is_numpys():
    random = np.random.default_rng(2)
    values = random.normal(size=(40, 12, 5)).astype(np.float32)
    values[random.uniform(size=values.shape) < 0.3] = np.nan
    values[:, 0] = 1.0
    assert np.allclose(_median(values), np.nanmedian(values, axis=1))
    values[3, :, 2] = np.nan
    assert np.isnan(_median(values)[3, 2])
