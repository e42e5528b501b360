# SPDX-License-Identifier: LGPL-2.1-or-later
"""The compat module against the layouts of Qt that FreeCAD ships: made up here, for the tests in the window see only one of them."""

import importlib
import sys
import types

import pytest


class Widget:
    def objectName(self):
        return ""


class Deleted:
    def objectName(self):
        raise RuntimeError("Internal C++ object already deleted.")


class OldLoop:
    def exec_(self, flags=None):
        return ("exec_", flags)


class NewLoop:
    def exec(self, flags=None):
        return ("exec", flags)


class NewEvent:
    def position(self):
        return "place"


class OldMouseEvent:
    def localPos(self):
        return "place"


def fake_qt(binding, version, *, widgets_apart, actions_in_gui):
    """Return modules as FreeCAD's PySide package has them."""
    core, gui, widgets = (types.ModuleType(f"PySide.{name}") for name in ("QtCore", "QtGui", "QtWidgets"))
    core.QObject = type("QObject", (), {"__module__": f"{binding}.QtCore"})
    core.Signal, core.QPointF = object, object
    core.qVersion = lambda: version
    places = {"QWidget": widgets, "QDialog": widgets, "QAction": gui if actions_in_gui else widgets}
    for name, module in places.items():
        setattr(module if widgets_apart else gui, name, type(name, (), {}))
    package = types.ModuleType("PySide")
    package.QtCore, package.QtGui = core, gui
    modules = {"PySide": package, "PySide.QtCore": core, "PySide.QtGui": gui}
    if widgets_apart:
        package.QtWidgets = widgets
        modules["PySide.QtWidgets"] = widgets
    return modules


LAYOUTS = {
    "0.20, PySide2 without QtWidgets": fake_qt("PySide2", "5.15.8", widgets_apart=False, actions_in_gui=False),
    "0.21 to 1.0, PySide2": fake_qt("PySide2", "5.15.13", widgets_apart=True, actions_in_gui=False),
    "1.1, PySide6": fake_qt("PySide6", "6.8.1", widgets_apart=True, actions_in_gui=True),
}


@pytest.fixture(params=LAYOUTS.values(), ids=LAYOUTS)
def compat(request, monkeypatch):
    for name in ("PySide", "PySide.QtCore", "PySide.QtGui", "PySide.QtWidgets"):
        monkeypatch.delitem(sys.modules, name, raising=False)
    for name, module in request.param.items():
        monkeypatch.setitem(sys.modules, name, module)
    monkeypatch.delitem(sys.modules, "pipeworkbench.gui.compat", raising=False)
    yield importlib.import_module("pipeworkbench.gui.compat")
    del sys.modules["pipeworkbench.gui.compat"]


def test_classes_are_found_wherever_qt_has_them(compat):
    assert compat.QAction.__name__ == "QAction"
    assert compat.QtWidgets.QDialog.__name__ == "QDialog"


def test_event_loops_run_with_the_bindings_own_name(compat):
    old = compat.qt_version() < (6,)
    assert compat.execute(OldLoop() if old else NewLoop(), "flags") == ("exec_" if old else "exec", "flags")
    assert compat.execute(NewLoop()) == ("exec", None)


def test_events_tell_their_place_in_both(compat):
    for event in (NewEvent(), OldMouseEvent()):
        assert compat.event_position(event) == "place"


def test_modules_come_from_the_binding_that_runs(compat, monkeypatch):
    binding = compat.QtCore.QObject.__module__.split(".")[0]
    package, svg = types.ModuleType(binding), types.ModuleType(f"{binding}.QtSvg")
    package.__path__ = []
    monkeypatch.setitem(sys.modules, binding, package)
    monkeypatch.setitem(sys.modules, f"{binding}.QtSvg", svg)
    assert compat.qt_module("QtSvg") is svg
    with pytest.raises(ImportError):
        compat.qt_module("QtNothing")


def test_what_qt_has_deleted_is_not_alive(compat):
    assert compat.is_alive(Widget())
    assert not compat.is_alive(Deleted())
    assert not compat.is_alive(None)
