# SPDX-License-Identifier: LGPL-2.1-or-later
"""Interior orientations for tests: some of each model, and hypothesis strategies that draw others."""

import numpy as np
from hypothesis import strategies as st

from pipeworkbench.recon.camera import OpenCVInterior, PhotogrammetricInterior

WIDTH, HEIGHT = 1280, 960


def whole_sensor(interior, columns=17, rows=13):
    """Return pixels (n, 2) spread over the image, its corners included."""
    u, v = np.meshgrid(np.linspace(0, interior.width - 1, columns), np.linspace(0, interior.height - 1, rows))
    return np.column_stack([u.ravel(), v.ravel()])


def every_tenth_pixel(interior):
    """Return every tenth pixel (n, 2) of every tenth row and the last ones."""
    columns, rows = (np.unique([*range(0, size, 10), size - 1]).astype(float) for size in (interior.width, interior.height))
    u, v = np.meshgrid(columns, rows)
    return np.column_stack([u.ravel(), v.ravel()])


def opencv(distortion, focal=1500.0):
    return OpenCVInterior(WIDTH, HEIGHT, focal, focal * 1.01, 655.0, 470.0, tuple(distortion))


def photogrammetric(principal_distance=26.0, **terms):
    return PhotogrammetricInterior(2592, 1944, 0.004, principal_distance, (-0.05, 0.03), r0=4.0, **terms)


STRONG = opencv((-0.3, 0.12, 1e-3, -8e-4, -0.02))
RIG = {"A1": -1.8e-4, "A2": 2.6e-7, "B1": -1.5e-5, "B2": 1.3e-5, "C1": -8e-6, "C2": 2.7e-5}  # of the paper's size

# as many as OpenCV's functions take
COEFFICIENTS = {
    0: (),
    4: (-0.28, 0.11, 1e-3, -7e-4),
    5: (-0.28, 0.11, 1e-3, -7e-4, -0.03),
    8: (0.2, 0.05, 1e-3, -7e-4, 0.01, 0.45, 0.02, 0.01),
    12: (0.2, 0.05, 1e-3, -7e-4, 0.01, 0.45, 0.02, 0.01, 2e-3, -1e-3, -1.5e-3, 8e-4),
    14: (0.2, 0.05, 1e-3, -7e-4, 0.01, 0.45, 0.02, 0.01, 2e-3, -1e-3, -1.5e-3, 8e-4, 0.03, -0.05),
}

opencv_interiors = st.builds(
    lambda k1, k2, p1, p2, focal: opencv((k1, k2, p1, p2), focal),
    st.floats(-0.3, 0.3),
    st.floats(-0.05, 0.1),
    st.floats(-2e-3, 2e-3),
    st.floats(-2e-3, 2e-3),
    st.floats(1400, 4000),
)
full_opencv_interiors = st.builds(
    lambda radial, decentring, prism, tilt, focal: opencv((*radial[:2], *decentring, *radial[2:], *prism, *tilt), focal),
    st.tuples(*(st.floats(-0.15, 0.15) for _ in range(2)), *(st.floats(-0.02, 0.05) for _ in range(4))),
    st.tuples(*(st.floats(-2e-3, 2e-3) for _ in range(2))),
    st.tuples(*(st.floats(-2e-3, 2e-3) for _ in range(4))),
    st.tuples(*(st.floats(-0.1, 0.1) for _ in range(2))),
    st.floats(1400, 4000),
)
photogrammetric_interiors = st.builds(
    lambda a1, a2, b1, b2, c1, c2: photogrammetric(A1=a1, A2=a2, B1=b1, B2=b2, C1=c1, C2=c2),
    st.floats(-1.5e-3, 1.5e-3),
    st.floats(-2e-6, 2e-6),
    st.floats(-1e-4, 1e-4),
    st.floats(-1e-4, 1e-4),
    st.floats(-1e-3, 1e-3),
    st.floats(-1e-3, 1e-3),
)
interiors = opencv_interiors | full_opencv_interiors | photogrammetric_interiors
