# SPDX-License-Identifier: LGPL-2.1-or-later
"""Times the steps of the main job on the bundled sample, beside a peer where there is one.

    python bench/reconstruct.py [STATION_DIR]

The peer of edge detection is OpenCV's Canny in the same run: it finds whole pixels only, but anybody
knows how fast it is.
"""

import resource
import statistics
import sys
import tempfile
import time
from pathlib import Path

import cv2

from pipeworkbench.exports.writers import Result, write
from pipeworkbench.recon.edges import detect_edges
from pipeworkbench.recon.images import read_image
from pipeworkbench.recon.picks import read_picks
from pipeworkbench.recon.reconstruct import reconstruct
from pipeworkbench.recon.station import read_station

SAMPLE = Path(__file__).resolve().parent.parent / "resources" / "samples" / "dummy" / "A"
REPEATS = 3


def timed(name, function, repeats=REPEATS):
    """Print the median of a few runs and return the last result."""
    seconds, result = [], None
    for _ in range(repeats):
        began = time.perf_counter()
        result = function()
        seconds.append(time.perf_counter() - began)
    print(f"{name:34s} {statistics.median(seconds):7.3f} s   (of {repeats}: {min(seconds):.3f} to {max(seconds):.3f})")
    return result


def main():
    """Run the benchmark."""
    station = read_station(Path(sys.argv[1]) if len(sys.argv) > 1 else SAMPLE)
    picks = read_picks(station.source.parent / "picks.json", station)
    image = timed("read one image", lambda: read_image(station, 0))
    print(f"{'':34s} {image.shape[1]} x {image.shape[0]} pixels")
    edges = timed("subpixel edges of one image", lambda: detect_edges(image))
    timed("  peer: OpenCV's Canny", lambda: cv2.Canny(cv2.GaussianBlur(image, (0, 0), 1.2), 20, 60))
    print(f"{'':34s} {len(edges)} edge points")
    found = timed(f"edges of all images, {len(picks.pipes)} picks", lambda: reconstruct(station, picks))
    result = Result(found.pipeline, (station,))
    with tempfile.TemporaryDirectory() as folder:
        for ending in (".json", ".csv", ".ifc", ".step", ".png"):
            path = Path(folder) / f"out{ending}"
            timed(f"write {ending}", lambda path=path: write(result, path), 1)
    print(f"peak memory {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024:.0f} MB")


if __name__ == "__main__":
    main()
