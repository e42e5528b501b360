# SPDX-License-Identifier: LGPL-2.1-or-later
"""Times of the photo window in FreeCAD's own window.

Run inside FreeCAD: ``freecad bench/photo_window.py`` (under Xvfb: ``xvfb-run -a -s "-screen 0 1600x1000x24" freecad ...``).
PIPEWORKBENCH_STATION names another station.json than the bundled sample's. The figures are printed, and FreeCAD is ended.

- import to visible: from the file to the last photograph on the screen;
- hover: a movement of the pointer until the highlighted edge and the search band are painted;
- frame: a zoom or pan step until all photographs are painted, with all layers that are on;
- projection: a candidate pipe's radius changes, its contour is computed in all images and painted;
- pick: from the second click of the Pipe tool on an edge until a pipe is drawn, and until the answer is complete (the sample's first five picks);
- radius drag: the tool's slider moves until the pipe is painted in all photographs;
- document: one diameter changes in 300 components, until their solids are made and the window is up to date again;
- language: until menus and toolbars are translated.
"""

from __future__ import annotations

import json
import os
import sys
import tempfile
import time
import traceback
from collections.abc import Callable
from pathlib import Path
from typing import Any

import FreeCAD
import FreeCADGui
import numpy as np

from pipeworkbench.gui.compat import QtCore, QtWidgets, qt_module

ROOT = Path(__file__).resolve().parent.parent
SAMPLE = ROOT / "resources" / "samples" / "dummy" / "A" / "station.json"
PICKS = 5
LARGER = (4000, 3000)  # 12 megapixels
STEPS = 60
DEADLINE_S = 120.0


def main() -> None:
    """Measure and print."""
    FreeCADGui.activateWorkbench("PipeWorkbench")
    source = Path(os.environ.get("PIPEWORKBENCH_STATION", SAMPLE))
    measure(source)
    with tempfile.TemporaryDirectory() as folder:
        measure(enlarged(source, Path(folder)))
    measure_picks()
    measure_document()
    measure_language()
    print(f"load of the machine in the last minute {os.getloadavg()[0]:.1f}, {os.cpu_count()} processors")


def measure(source: Path) -> None:
    """Print the figures of one station."""
    from pipeworkbench.commands.import_station import import_station
    from pipeworkbench.gui.photos.windows import open_photo_window

    document = FreeCAD.newDocument("bench")
    began = time.perf_counter()
    window = open_photo_window(import_station(source, document))
    wait_until(lambda: all(canvas.picture for canvas in window.canvases))
    painted(window)
    visible = time.perf_counter() - began
    wait_until(lambda: window.views is not None)
    edges = time.perf_counter() - began
    width, height = window.canvases[0].size_of_photograph
    size = f"{width * height / 1e6:.1f} MP, {len(window.canvases)} photographs"
    shown = f"{window.canvases[0].width()} x {window.canvases[0].height()} on the screen"
    print(f"\n{source} ({size}, each {shown})")
    print(f"import to visible  {visible:6.2f} s; edges of all after {edges:.2f} s ({sum(len(view.edges) for view in window.views)} points)")
    tell("hover, no layers", hovering(window))
    window.layer("epipolar").visible = True
    tell("hover, search band", hovering(window))
    window.layer("epipolar").visible = False
    window.fit()
    tell("zoom", [timed(window, lambda i=i: zoom(window, i)) for i in range(STEPS)])
    window.show_place(window.canvases[0].camera, (width / 2, height / 2), 1.0)
    tell("pan at 1:1", [timed(window, lambda i=i: pan(window, i)) for i in range(STEPS)])
    window.show_layer("edges", shown=True)
    tell("pan at 1:1, edges", [timed(window, lambda i=i: pan(window, i)) for i in range(STEPS)])
    window.fit()
    tell("zoom, edges", [timed(window, lambda i=i: zoom(window, i)) for i in range(STEPS)])
    window.show_layer("edges", shown=False)
    window.fit()
    tell("gamma slider", [timed(window, lambda i=i: window.toolbar.gamma.setValue(20 + i)) for i in range(STEPS)])
    tell("projection", [timed(window, lambda i=i: project(window, 50.0 + i)) for i in range(STEPS)])
    FreeCAD.closeDocument(document.Name)
    wait_until(lambda: FreeCAD.ActiveDocument is None)


def measure_picks() -> None:
    """Print how long the Pipe tool takes for picks of the sample, and how it follows its slider."""
    from pipeworkbench.commands.import_station import import_station
    from pipeworkbench.gui.tools.pipe_tool import PipeTool

    document = FreeCAD.newDocument("picks")
    tool = PipeTool(import_station(SAMPLE, document))
    tool.open()
    wait_until(lambda: tool.window.views is not None)
    picks = json.loads(SAMPLE.with_name("picks.json").read_text(encoding="utf-8"))["picks"]
    firsts, answers = [], []
    print()
    for pick in [pick for pick in picks if pick["kind"] == "pipe"][:PICKS]:
        one, other = np.mean(pick["edges"], axis=1)
        tool.window.show_place(pick["camera"], tuple(((one + other) / 2).tolist()), 1.0)
        painted(tool.window)
        click(tool.window, pick["camera"], one)
        began = time.perf_counter()
        click(tool.window, pick["camera"], other)
        wait_until(lambda: tool.measurement.shown is not None or not tool.measurement.is_measuring)
        painted(tool.window)
        firsts.append(time.perf_counter() - began)
        wait_until(lambda: not tool.measurement.is_measuring)
        answers.append(time.perf_counter() - began)
        if len(answers) < PICKS:
            while tool.measurement.touches:
                tool.window.stepped_back.emit()
    for name, times in (("pick to projection", firsts), ("pick to answer", answers)):
        print(f"{name:18s} {np.median(times):6.2f} s median, {max(times):6.2f} s worst  ({len(times)} picks)", flush=True)
    slider = tool.form.findChild(QtWidgets.QSlider, "drag")
    slider.setSliderDown(True)
    tell("radius drag", [timed(tool.window, lambda i=i: slider.setValue(3 * i)) for i in range(1, STEPS + 1)])
    tool.close()
    FreeCAD.closeDocument(document.Name)
    wait_until(lambda: FreeCAD.ActiveDocument is None)


def click(window: Any, camera: str, point: Any) -> None:
    """Click on a pixel of a photograph that the window shows."""
    canvas = window.canvas(camera)
    place = canvas.screen_at((float(point[0]), float(point[1]))).toPoint()
    qt_module("QtTest").QTest.mouseClick(canvas, QtCore.Qt.MouseButton.LeftButton, QtCore.Qt.KeyboardModifier.NoModifier, place)


def measure_document() -> None:
    """Print how long one changed diameter takes in the document of bench/recompute.py, with its 3D view."""
    sys.path.insert(0, str(ROOT / "bench"))
    from recompute import components

    from pipeworkbench.features.document import add_pipeline
    from pipeworkbench.gui.view_providers import show

    document = FreeCAD.newDocument("large")
    document.UndoMode = 1
    objects = list(add_pipeline(document, components()))
    for obj in objects:
        show(obj)
    document.recompute()
    FreeCADGui.SendMsgToActiveView("ViewFit")
    QtWidgets.QApplication.processEvents()
    pipe = next(obj for obj in objects if obj.ComponentId == "04-P6")
    times = []
    for size in ("DN 65", "DN 40", "DN 80", "DN 40", "DN 50"):
        began = time.perf_counter()
        document.openTransaction("change")
        pipe.NominalDiameter = size
        document.recompute()
        document.commitTransaction()
        QtWidgets.QApplication.processEvents()
        times.append(time.perf_counter() - began)
    print(f"{'one diameter':18s} {np.median(times):6.2f} s median, {max(times):6.2f} s worst  ({len(objects)} components)", flush=True)
    FreeCAD.closeDocument(document.Name)


def measure_language() -> None:
    """Print how long FreeCAD takes to change its language with this workbench."""
    times = []
    for language in ("German", "English") * 2:
        began = time.perf_counter()
        FreeCADGui.setLocale(language)
        QtWidgets.QApplication.processEvents()
        times.append(time.perf_counter() - began)
    print(f"{'language':18s} {np.median(times):6.2f} s median, {max(times):6.2f} s worst", flush=True)


def hovering(window: Any) -> list[float]:
    """Return the times of movements over a photograph, with snapping."""
    test = qt_module("QtTest").QTest
    canvas = window.canvases[0]
    window.show_place(canvas.camera, tuple(x / 2 for x in canvas.size_of_photograph), 1.0)
    window.set_tool(True, snapping=True)
    places = np.random.default_rng(1).uniform(20, (canvas.width() - 20, canvas.height() - 20), (STEPS * 3, 2)).astype(int).tolist()
    times = [timed(window, lambda u=u, v=v: test.mouseMove(canvas, QtCore.QPoint(u, v))) for u, v in places]
    window.set_tool(False)
    return times


def zoom(window: Any, step: int) -> None:
    """Zoom in and out to a place beside the middle."""
    canvas = window.canvases[0]
    factor = 1.12 if step % STEPS < STEPS // 2 else 1 / 1.12
    canvas.zoomed.emit(factor, QtCore.QPointF(canvas.width() / 3, canvas.height() / 2))


def pan(window: Any, step: int) -> None:
    """Move back and forth."""
    window.canvases[0].panned.emit(QtCore.QPointF(7 if step % 20 < 10 else -7, 3))


def project(window: Any, diameter: float) -> None:
    """Draw a candidate's contour in all photographs."""
    from pipeworkbench.pipeline import Pipe
    from pipeworkbench.recon.image_curves import contours_in

    pipe = Pipe(id="candidate", start=(-600.0, 4000.0, 100.0), end=(600.0, 4200.0, 0.0), outer_diameter=diameter)
    layer = window.layer("candidate")
    for camera, lines in contours_in(window.station, [pipe])[0].items():
        layer.set_polylines(camera, lines, "#ffe14d")


def enlarged(source: Path, folder: Path) -> Path:
    """Write a station with the same photographs at 12 megapixels."""
    import cv2

    data = json.loads(source.read_text(encoding="utf-8"))
    for camera in data["cameras"]:
        grey = cv2.imread(str(source.parent / camera["image"]), cv2.IMREAD_GRAYSCALE)
        large = cv2.resize(grey, LARGER, interpolation=cv2.INTER_CUBIC)
        noise = np.random.default_rng(0).normal(0, 2, large.shape)
        camera["image"] = f"{camera['name']}.jpg"
        cv2.imwrite(str(folder / camera["image"]), np.clip(large + noise, 0, 255).astype(np.uint8))
        camera["interior"]["pixel_pitch"] *= camera["width"] / LARGER[0]
        camera["width"], camera["height"] = LARGER
    (folder / "station.json").write_text(json.dumps(data), encoding="utf-8")
    return folder / "station.json"


def timed(window: Any, action: Callable[[], Any]) -> float:
    """Return how long an action takes until it is painted, in ms."""
    began = time.perf_counter()
    action()
    painted(window)
    return (time.perf_counter() - began) * 1000


def painted(window: Any) -> None:
    """Let Qt deliver and paint what is due."""
    QtWidgets.QApplication.processEvents()
    pending = QtCore.Qt.WidgetAttribute.WA_PendingUpdate
    wait_until(lambda: not any(canvas.testAttribute(pending) for canvas in window.canvases))


def tell(name: str, times: list[float]) -> None:
    """Print median and 95th percentile."""
    median, most = np.percentile(times, [50, 95])
    print(f"{name:18s} {median:6.1f} ms median, {most:6.1f} ms 95 %  ({1000 / median:.0f} per second)", flush=True)


def wait_until(condition: Callable[[], bool]) -> None:
    """Let the window live until a condition holds."""
    end = time.monotonic() + DEADLINE_S
    while not condition():
        if time.monotonic() > end:
            raise TimeoutError
        QtWidgets.QApplication.processEvents()
        time.sleep(0.002)


def run() -> None:
    """Measure, then end FreeCAD."""
    try:
        main()
    except BaseException:  # noqa: BLE001  # FreeCAD would swallow it
        traceback.print_exc()
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(0)


QtCore.QTimer.singleShot(2500, run)
