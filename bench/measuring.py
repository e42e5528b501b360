# SPDX-License-Identifier: LGPL-2.1-or-later
"""How exactly and how fast edges, lines and contours are measured, beside peers in the same run.

    python bench/measuring.py [STATION_DIR ...]

Prints, side by side:
- the offset of lines fitted to edges against the Cramer-Rao bound, for both methods of the product and the peer;
- the bias on straight edges of any direction and on circles, with and without the correction for curvature;
- the time for images of 5 to 24 megapixels beside the peers, and the memory for 12;
- the time of matching 10,000 contour samples;
- lines on the picked edges of the stations given (real photographs), with their residuals.

Peers: OpenCV's Canny (whole pixels only, but anybody knows how fast it is) and, where it is installed
(`pip install subpixel-edges`), an implementation of the partial-area method that is compiled by Numba.
"""

import statistics
import subprocess
import sys
import time
import warnings
from pathlib import Path

import cv2
import numpy as np
from scipy.special import ndtr

from pipeworkbench.recon import gradient_edges
from pipeworkbench.recon.edges import EdgeSettings, detect_edges
from pipeworkbench.recon.images import read_image
from pipeworkbench.recon.lines import detect_lines
from pipeworkbench.recon.match import match
from pipeworkbench.recon.picks import read_picks
from pipeworkbench.recon.station import read_station

CONTRAST, NOISE, LENGTH = 60.0, 2.0, 120
ORIENTATIONS, REPETITIONS = 24, 40  # 960 lines tell their RMS to 2.3 %
SIZE = 160
NODES, WEIGHTS = np.polynomial.legendre.leggauss(3)
SAMPLE = Path(__file__).resolve().parent.parent / "resources" / "samples" / "dummy" / "A"
SEARCH_RANGE = 12.0  # px
FRESH = "import sys; sys.path.insert(0, {folder!r}); import measuring; measuring.memory()"


def peer():
    """Return the peer as a function image -> positions (n, 2), None where it is not installed."""
    try:
        # it was written for NumPy 2, where this is the name of the type
        np.bool = np.bool_
        from subpixel_edges import subpixel_edges
    except ImportError:
        return None

    def positions(image):
        found = subpixel_edges(image.astype(float), 15, 0, 2)
        return np.column_stack([found.x, found.y])

    return positions


METHODS = {
    "gradient (default)": lambda image: detect_edges(image).position,
    "partial area": lambda image: detect_edges(image, EdgeSettings(method="partial area")).position,
}


def half_plane(angle, offset, blur, low, high, noise=0.0, random=None):
    """Return a picture of a straight edge; a pixel is the mean over its area."""
    v, u = np.mgrid[:SIZE, :SIZE] - (SIZE - 1) / 2
    image = np.zeros((SIZE, SIZE))
    for du, wu in zip(NODES / 2, WEIGHTS / 2, strict=True):
        for dv, wv in zip(NODES / 2, WEIGHTS / 2, strict=True):
            image += wu * wv * ndtr(((u + du) * np.cos(angle) + (v + dv) * np.sin(angle) - offset) / blur)
    image = low + (high - low) * image
    if noise:
        image = image + random.normal(0, noise, image.shape)
    return np.clip(np.rint(image), 0, 255).astype(np.uint8)


def disc(radius, centre, blur, fine=8, size=120):
    """Return a picture of a bright disc."""
    v, u = (np.mgrid[: size * fine, : size * fine] + 0.5) / fine - 0.5
    image = cv2.GaussianBlur(np.clip((radius - np.hypot(u - centre[0], v - centre[1])) * fine + 0.5, 0, 1), (0, 0), blur * fine)
    return np.rint(60 + 120 * cv2.resize(image, (size, size), interpolation=cv2.INTER_AREA)).astype(np.uint8)


def line_offset(positions, angle, offset):
    """Return how far the line through edge points lies beside the true one, at its middle."""
    local = positions - (SIZE - 1) / 2
    across = local @ [np.cos(angle), np.sin(angle)] - offset
    along = local @ [-np.sin(angle), np.cos(angle)]
    near = (np.abs(across) < 1.5) & (np.abs(along) <= LENGTH / 2)
    return np.polynomial.polynomial.polyfit(along[near], across[near], 1)[0]


def accuracy(methods):
    print(f"\nOffset of fitted lines, contrast {CONTRAST:g}, noise {NOISE:g}, {LENGTH} px, {ORIENTATIONS * REPETITIONS} orientations")
    print(f"{'method':22s} {'blur':>5s} {'RMS px':>8s} {'bound px':>9s} {'ratio':>6s}   (asked: at most 1.25)")
    for name, positions in methods.items():
        for blur in (0.6, 1.0):
            random = np.random.default_rng(1)
            errors = []
            for _ in range(ORIENTATIONS * REPETITIONS):
                angle, offset = random.uniform(0, 2 * np.pi), random.uniform(-0.5, 0.5)
                errors.append(line_offset(positions(half_plane(angle, offset, blur, 90, 90 + CONTRAST, NOISE, random)), angle, offset))
            bound = NOISE / CONTRAST * np.sqrt(2 * np.sqrt(np.pi) * np.sqrt(blur**2 + 1 / 12) / LENGTH)
            rms = np.sqrt(np.mean(np.square(errors)))
            print(f"{name:22s} {blur:5.1f} {rms:8.4f} {bound:9.4f} {rms / bound:6.2f}")


def bias(methods):
    print("\nBias without noise: straight edges of 48 orientations, circles of radius 40 px at blur 1.0")
    print(f"{'method':34s} {'line mean':>9s} {'line max':>9s} {'circle mean':>11s} {'circle max':>11s}   (asked: 0.005 and 0.02)")

    def row(name, positions):
        lines = []
        for number in range(48):
            angle, offset = (number + 0.37) * np.pi / 24, (number * 0.618) % 1 - 0.5
            lines.append(line_offset(positions(half_plane(angle, offset, 0.6 + 0.4 * (number % 2), 80, 200)), angle, offset))
        means, largest = [], 0.0
        for centre in ((59.7, 60.2), (60.0, 60.0), (59.37, 60.71)):
            off = np.hypot(*(positions(disc(40, centre, 1.0)) - centre).T) - 40
            off = off[np.abs(off) < 2]
            means.append(off.mean())
            largest = max(largest, np.abs(off).max())
        print(f"{name:34s} {np.mean(lines):9.5f} {np.abs(lines).max():9.5f} {np.mean(means):11.4f} {largest:11.4f}")

    for name, positions in methods.items():
        row(name, positions)
    most = gradient_edges.MOST_CURVED
    gradient_edges.MOST_CURVED = 0.0
    row("gradient, curvature not corrected", METHODS["gradient (default)"])
    gradient_edges.MOST_CURVED = most


def timed(function, repeats=7):
    """Return the median seconds of some runs after a first one."""
    function()
    seconds = []
    for _ in range(repeats):
        began = time.perf_counter()
        function()
        seconds.append(time.perf_counter() - began)
    return statistics.median(seconds)


def speed(image, other):
    print("\nTime for an image, ms")
    print(f"{'pixels':>14s} {'edges':>8s} {'ours':>7s} {'ours/MP':>8s} {'Canny':>7s} {'ratio':>6s} {'peer':>7s} {'ratio':>6s}   (asked: 6 and 0.5)")
    for width, height in ((2592, 1944), (4000, 3000), (6000, 4000)):
        tiles = (-(-height // image.shape[0]), -(-width // image.shape[1]))
        large = np.ascontiguousarray(np.tile(image, tiles)[:height, :width])
        found = len(detect_edges(large))
        ours = timed(lambda large=large: detect_edges(large))
        canny = timed(lambda large=large: cv2.Canny(large, 20, 60))
        its = timed(lambda large=large: other(large), 3) if other is not None and width < 3000 else np.nan
        print(
            f"{width:6d} x {height:5d} {found:8d} {1e3 * ours:7.0f} {1e9 * ours / width / height:8.1f} {1e3 * canny:7.0f} {ours / canny:6.1f}"
            f" {1e3 * its:7.0f} {ours / its:6.2f}"
        )


def memory():
    """Print the memory that edges of a 12-megapixel image take: in a process of its own."""
    image = read_image(read_station(SAMPLE), 0)
    large = np.ascontiguousarray(np.tile(image, (3, 3))[:3000, :4000])
    before = _peak_megabytes()
    detect_edges(large)
    print(f"\nMemory for 12 megapixels: {_peak_megabytes():.0f} MB at most, {before:.0f} MB of them before (asked: below 1000)")


def _peak_megabytes():
    # what resource.getrusage says includes the parent's memory
    status = Path("/proc/self/status").read_text(encoding="ascii")
    return int(status.split("VmHWM:")[1].split()[0]) / 1024


def matching(image):
    edges = detect_edges(image)
    random = np.random.default_rng(0)
    starts, angle = random.uniform((100, 100), np.array(image.shape[::-1]) - 300, (40, 2)), np.linspace(0, np.pi, 40)
    tangent = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    positions = (starts[:, None] + np.linspace(0, 250, 250)[None, :, None] * tangent[:, None]).reshape(-1, 2)
    normals = np.repeat(np.stack([-tangent[:, 1], tangent[:, 0]], axis=1), 250, axis=0)
    seconds = timed(lambda: match(edges, positions, normals, SEARCH_RANGE), 21)
    print(f"\nMatching {len(positions)} contour samples, range {SEARCH_RANGE:g} px, {len(edges)} edges: {1e3 * seconds:.1f} ms (asked: below 20)")


def real_lines(folder):
    station = read_station(folder)
    picks = read_picks(station.source.parent / "picks.json", station)
    print(f"\nLines on the picked edges of {station.name} (asked: residual RMS below 0.3 px)")
    print(f"{'camera':>8s} {'method':>7s} {'lines':>6s} {'picked edges':>13s} {'found':>6s} {'median RMS':>11s} {'largest RMS':>12s} {'s':>6s}")
    for camera in sorted({pick.camera for pick in picks.pipes}):
        image = read_image(station, camera)
        edges = detect_edges(image)
        picked = np.concatenate([pick.edges for pick in picks.pipes if pick.camera == camera])
        for method in ("lsd", "hough"):
            began = time.perf_counter()
            lines = detect_lines(image, edges, method, station.cameras[camera].interior)
            seconds = time.perf_counter() - began
            view, origin = station.cameras[camera].interior, station.cameras[camera].interior.pixels(np.zeros((1, 2)))
            ends = view.ideal(picked.reshape(-1, 2)).reshape(-1, 2, 2) * view.pixels_per_radian + origin
            residuals = [best for best in (_residual_of(lines, *pair) for pair in ends) if best is not None]
            print(
                f"{station.cameras[camera].name:>8s} {method:>7s} {len(lines):6d} {len(picked):13d} {len(residuals):6d}"
                f" {np.median(residuals):11.3f} {max(residuals):12.3f} {seconds:6.2f}"
            )


def _residual_of(lines, first, second):
    """Return the residual RMS of the longest line along a picked edge, None where there is none."""
    along = (second - first) / np.linalg.norm(second - first)
    middle = (first + second) / 2
    off = np.abs(np.einsum("ij,ij->i", middle - lines.centre, lines.normal))
    apart = np.abs((lines.centre - middle) @ along) - (lines.length + np.linalg.norm(second - first)) / 2
    fits = (off < 6) & (np.abs(lines.direction @ [-along[1], along[0]]) < 0.05) & (apart < 0)
    return float(lines.residual_rms[np.flatnonzero(fits)[0]]) if fits.any() else None


def main():
    """Run the benchmark."""
    warnings.simplefilter("ignore")
    other = peer()
    methods = dict(METHODS)
    if other is not None:
        methods["peer subpixel-edges"] = other
    else:
        print("The peer is not installed: pip install subpixel-edges")
    accuracy(methods)
    bias(methods)
    image = read_image(read_station(SAMPLE), 0)
    image = np.ascontiguousarray(np.tile(image, (2, 2))[:1944, :2592])
    for folder in sys.argv[1:]:
        station = read_station(Path(folder))
        if station.cameras[0].interior.width * station.cameras[0].interior.height > 4e6:
            image = read_image(station, 0)
            break
    speed(image, other)
    subprocess.run([sys.executable, "-c", FRESH.format(folder=str(Path(__file__).resolve().parent))], check=True)
    matching(image)
    for folder in sys.argv[1:]:
        real_lines(Path(folder))


if __name__ == "__main__":
    main()
