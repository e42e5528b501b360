# SPDX-License-Identifier: LGPL-2.1-or-later
"""Make the pictures of docs/images anew: the screenshots that the tests in FreeCAD's window take, and a cut sheet, made small.

``.venv/bin/python scripts/pictures.py``; needs what ``make test`` needs, and pdftoppm (Debian's poppler-utils).
A picture that would be larger than `LARGEST_BYTES` gets fewer greys.
"""

from __future__ import annotations

import io
import os
import shutil
import subprocess
import sys
import sysconfig
import tempfile
from pathlib import Path

import numpy as np
from PIL import Image

ROOT = Path(__file__).resolve().parent.parent
TARGET = ROOT / "docs" / "images"
TESTS = ("conftest.py", "window.py", "test_whole_way.py", "test_pipeline_tools.py", "test_insulation.py")
PICTURES = {  # the tests' names of them, and the file's
    "way_pipe": "pipe",
    "way_elbows": "elbows",
    "way_flange": "flange",
    "way_adjust": "adjust",
    "way_3d": "result",
    "merge": "merge",
    "deviations": "deviations",
    "report": "report",
    "insulation": "insulation",
    "cut_sheets": "cut_sheets",
}
WIDTH = 1200
LARGEST_BYTES = 150_000
COLOURS, GREYS = 64, (96, 64, 48, 32, 24, 16, 12)  # in a picture's palette
COLOURED = 40  # between a colour's largest and smallest part
SHEET_OF = ROOT / "tests" / "data" / "one_of_everything.json"
SHEET = ("-f", "1", "-singlefile", "-r", "150", "-png")  # the first page, in dots per inch
SHEET_BOX = (0.02, 0.02, 0.98, 0.98)  # of the page: left, top, right, bottom
SCREEN = "-screen 0 1600x1000x24"


def main() -> int:
    """Run the tests, shrink what they took, and tell how large it is."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        take(folder)
        draw_sheet(folder)
        missing = [taken for taken in PICTURES if not (folder / "shots" / f"{taken}.png").is_file()]
        if missing:
            print((folder / "log").read_text(encoding="utf-8", errors="replace")[-4000:])
            print("not taken:", ", ".join(missing))
            return 1
        TARGET.mkdir(parents=True, exist_ok=True)
        for taken, kept in PICTURES.items():
            data = shrunk(folder / "shots" / f"{taken}.png")
            (TARGET / f"{kept}.png").write_bytes(data)
            print(f"{kept}.png {len(data) // 1000} kB")
    return 0


def take(folder: Path) -> None:
    """Run the tests in a FreeCAD with a home of its own, as scripts/test.sh does."""
    home, shots, tests = (folder / part for part in ("home", "shots", "tests"))
    for made in (home, shots, tests):
        made.mkdir()
    for test in TESTS:
        shutil.copy(ROOT / "tests" / "gui" / test, tests)
    shutil.copy(ROOT / "tests" / "gui" / "user.cfg", folder)
    environment = os.environ | {
        "HOME": str(home),
        "LANG": "C.UTF-8",
        "PYTHONPATH": f"{ROOT}{os.pathsep}{sysconfig.get_path('purelib')}",
        "PYTHONDONTWRITEBYTECODE": "1",
        "QTWEBENGINE_DISABLE_SANDBOX": "1",
        "PIPEWORKBENCH_SCREENSHOTS": str(shots),
        "PIPEWORKBENCH_TESTS": str(tests),
        "PIPEWORKBENCH_EXIT": str(folder / "exit"),
    }
    subprocess.run([ROOT / "scripts" / "install.sh"], env=environment, check=True)
    command = ["xvfb-run", "-a", "-s", SCREEN, "freecad", "-u", str(folder / "user.cfg"), str(ROOT / "tests" / "run_in_freecad.py")]
    with (folder / "log").open("wb") as log:
        subprocess.run(command, env=environment, stdout=log, stderr=subprocess.STDOUT, timeout=600, check=False)


def draw_sheet(folder: Path) -> None:
    """Draw the first sheet of what is cut for the insulation of one of everything, as a picture beside the screenshots."""
    pdf, picture = folder / "sheets.pdf", folder / "shots" / "cut_sheets.png"
    command = [sys.executable, "-m", "pipeworkbench", "insulate", str(SHEET_OF), "--thickness", "40", "--leave-out", "--quiet", "--out", str(pdf)]
    subprocess.run(command, check=True, env=os.environ | {"PYTHONPATH": str(ROOT)})
    command = ["pdftoppm", *SHEET, str(pdf), str(picture.with_suffix(""))]
    subprocess.run(command, check=True)
    page = Image.open(picture)
    left, top, right, bottom = (round(part * side) for part, side in zip(SHEET_BOX, page.size * 2, strict=True))
    page.crop((left, top, right, bottom)).save(picture)


def shrunk(path: Path) -> bytes:
    """Return a picture as a PNG with a palette: all of its colours, and as many greys as its size allows (photographs are noisy)."""
    whole = Image.open(path).convert("RGB")
    small = whole.resize((WIDTH, whole.height * WIDTH // whole.width), Image.Resampling.LANCZOS)
    pixels = np.asarray(small).astype(int)
    coloured = pixels[np.ptp(pixels, axis=2) > COLOURED]
    palette = Image.fromarray(coloured[None].astype(np.uint8)).quantize(COLOURS).getpalette() or []
    data = b""
    for greys in GREYS:
        values = [round(255 * step / (greys - 1)) for step in range(greys) for _ in range(3)]
        both = Image.new("P", (1, 1))
        both.putpalette([*palette[: 3 * COLOURS], *values])
        written = io.BytesIO()
        small.quantize(palette=both, dither=Image.Dither.NONE).save(written, "PNG", optimize=True)
        data = written.getvalue()
        if len(data) <= LARGEST_BYTES:
            break
    return data


if __name__ == "__main__":
    sys.exit(main())
