# SPDX-License-Identifier: LGPL-2.1-or-later
"""The base of all task panels: one at a time, errors told in it, one transaction per Apply, and it follows its document.

A panel keeps no transaction open: what it shows before Apply are overlays and ghosts, so that undo, other commands and closing
the document are possible at any time.
"""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator
from typing import Any, TypeVar

import FreeCAD
import FreeCADGui

from pipeworkbench.errors import InputError
from pipeworkbench.features.transactions import transaction
from pipeworkbench.files import package_folder
from pipeworkbench.gui.colours import WARNING_TEXT
from pipeworkbench.gui.compat import QtCore, QtGui, QtWidgets, is_alive
from pipeworkbench.gui.dialogs import Cancelled
from pipeworkbench.gui.failures import failures_told
from pipeworkbench.gui.jobs import Progress
from pipeworkbench.gui.translation import tr
from pipeworkbench.gui.worker import run_long

T = TypeVar("T")
Buttons = QtWidgets.QDialogButtonBox.StandardButton
ESCAPE = QtCore.Qt.Key.Key_Escape
FRAME_PX, WIDEST_PX = 70, 480  # of the side panel: what FreeCAD puts around a panel; no more than that

_current: Panel | None = None


def open_panel() -> Panel | None:
    """Return the panel of this workbench that is open, None where there is none."""
    return _current


class Panel:
    """A FreeCAD task panel.

    Subclasses fill ``self.layout`` and override ``accept``, ``clicked``, ``refresh``, ``step_back``, ``discard`` as they need.
    Slots are connected as ``signal.connect(self.guard(function))``: whatever such a function raises is told in the panel.

    Attributes
    ----------
    form : QWidget
        What FreeCAD shows, with title and icon.
    layout : QVBoxLayout
        Of the part above the message.
    is_open : bool
    """

    title = ""
    icon = ""  # file in resources/icons
    buttons: tuple[Any, ...] = (Buttons.Ok, Buttons.Cancel)

    def __init__(self, document: Any = None) -> None:
        self.title = tr(self.title)
        document = document or FreeCAD.ActiveDocument
        if document is None:
            raise InputError(self.title, "", tr("there is no document"), tr("open one, or import a station first"))
        self._document_name: str = document.Name
        self._needed: set[str] = set()
        self._observer: _Observer | None = None
        self._refresh_is_due = False
        self.is_open = False
        self.form = QtWidgets.QWidget()
        self.form.setWindowTitle(self.title)
        self.form.setWindowIcon(QtGui.QIcon(str(package_folder("resources") / "icons" / self.icon)))
        outer = QtWidgets.QVBoxLayout(self.form)
        outer.setContentsMargins(6, 6, 6, 6)
        self.layout = QtWidgets.QVBoxLayout()
        outer.addLayout(self.layout)
        self._message = _message_label()
        outer.addWidget(self._message)
        self._keys = _Keys(self.form, self.step_back)
        self._button_box: Any = None
        self._disabled: set[int] = set()
        self.form.destroyed.connect(lambda *_: self._end())

    # what subclasses override

    def accept(self) -> bool:
        """Do what OK means (FreeCAD's name); True closes the panel. Use ``self.attempt`` so that errors leave it open."""
        self._end()
        return True

    def reject(self) -> bool:
        """Leave everything as it is and close (FreeCAD's name)."""
        self._end()
        return True

    def clicked(self, button: int) -> None:
        """Do what another standard button, such as Apply, means (FreeCAD's name)."""

    def refresh(self) -> None:
        """Show the document as it is now: it was undone, redone or changed by others."""

    def step_back(self) -> bool:
        """Take Esc in the panel: True where there was a step to take back, False to close the panel."""
        return False

    def has_result(self) -> bool:
        """Tell whether closing the panel would lose something that took the user's time; then it asks before."""
        return False

    def discard(self) -> None:
        """Take away overlays, ghosts and connections; called once when the panel ends, however it ends."""

    # what subclasses use

    @property
    def document(self) -> Any:
        """The document the panel works on.

        Raises
        ------
        InputError
            Where it was closed.
        """
        if self._document_name not in FreeCAD.listDocuments():
            raise InputError(self.title, "", tr("its document was closed"), tr("open it again"))
        return FreeCAD.getDocument(self._document_name)

    def depends_on(self, *objects: Any) -> None:
        """Close the panel when one of these document objects is deleted (or its creation undone)."""
        self._needed.update(obj.Name for obj in objects)

    def apply(self, name: str, function: Callable[[], T]) -> T:
        """Call a function that changes the document as one step of undo, which is undone where it raises."""
        with transaction(self.document, name):
            return function()

    def attempt(self, function: Callable[[], object]) -> bool:
        """Call a function; tell in the panel what it raises, and whether it went well."""
        with self.reporting():
            function()
            return True
        return False

    def guard(self, function: Callable[[], object]) -> Callable[..., None]:
        """Return a slot that calls a function, without the signal's arguments, and tells in the panel what it raises."""

        def slot(*_arguments: Any) -> None:
            with self.reporting():
                function()

        return slot

    @contextlib.contextmanager
    def reporting(self) -> Iterator[None]:
        """Run a block; what it raises is told in the panel and in the report view."""
        self.say("")
        with failures_told(self.title, self._warn):
            yield

    def enable_button(self, button: Any, *, enabled: bool) -> None:
        """Switch a standard button on or off, also before the panel is shown."""
        (self._disabled.discard if enabled else self._disabled.add)(_number(button))
        shown = self._button_box.button(button) if is_alive(self._button_box) else None
        if shown is not None:
            shown.setEnabled(enabled)

    def compute(self, function: Callable[[Progress], T]) -> T:
        """Run a function in a thread, as ``worker.run_long`` does; meanwhile nothing in the panel can be changed.

        Raises
        ------
        Cancelled
            Where the user pressed Cancel, or closed the panel or its document meanwhile.
        """
        self.form.setEnabled(False)
        try:
            result = run_long(self.title, function, self.document)
        finally:
            if is_alive(self.form):
                self.form.setEnabled(True)
        if not self.is_open:
            raise Cancelled
        return result

    def make_room(self) -> None:
        """Widen FreeCAD's side panel, once Qt has laid this one out, where it would be cut off; call it when the panel shows more."""
        QtCore.QTimer.singleShot(0, self._widen)

    def say(self, text: str, *, warning: bool = False) -> None:
        """Show a sentence at the panel's foot; none takes it away."""
        if not is_alive(self._message):
            return
        self._message.setText(text)
        self._message.setStyleSheet(f"color: {WARNING_TEXT}" if warning else "")
        self._message.setVisible(bool(text))

    # FreeCAD's side

    def open(self) -> None:
        """Show the panel, in place of another one of this workbench; FreeCAD calls this name, too, once it shows it.

        Raises
        ------
        InputError
            Where another task is open that is not this workbench's, or the user wants to keep the one that is.
        """
        global _current  # FreeCAD has one place for panels, too
        if self.is_open:
            return
        if _current is not None and not _may_close(_current):
            raise InputError(self.title, "", tr("'{panel}' is still open").format(panel=_current.title), tr("finish it first"))
        if _current is not None:
            _current.close()
        if FreeCADGui.Control.activeDialog():
            raise InputError(self.title, "", tr("another task is open in the task panel"), tr("finish or close it first"))
        _current, self.is_open = self, True
        FreeCADGui.Control.showDialog(self)
        self._observer = _Observer(self)
        FreeCAD.addDocumentObserver(self._observer)
        self.make_room()

    def close(self) -> None:
        """Close the panel, whoever asks for it; nothing is applied."""
        if self.is_open:
            self._end()
            FreeCADGui.Control.closeDialog()

    def getStandardButtons(self) -> int:  # FreeCAD's name
        """Tell FreeCAD which buttons to show."""
        return sum(map(_number, self.buttons))

    def modifyStandardButtons(self, box: Any) -> None:  # FreeCAD's name
        """Keep the buttons that FreeCAD made."""
        self._button_box = box
        for button in self.buttons:
            self.enable_button(button, enabled=_number(button) not in self._disabled)

    def isAllowedAlterDocument(self) -> bool:  # FreeCAD's name
        """Let other commands change the document: the panel follows."""
        return True

    def isAllowedAlterSelection(self) -> bool:  # FreeCAD's name
        """Let the user select."""
        return True

    def isAllowedAlterView(self) -> bool:  # FreeCAD's name
        """Let the user turn the view."""
        return True

    def _widen(self) -> None:
        if not is_alive(self.form):
            return
        dock = self.form.parent()
        while dock is not None and not isinstance(dock, QtWidgets.QDockWidget):
            dock = dock.parent()
        wanted = min(self.form.sizeHint().width() + FRAME_PX, WIDEST_PX)
        if dock is not None and not dock.isFloating() and dock.width() < wanted:
            FreeCADGui.getMainWindow().resizeDocks([dock], [wanted], QtCore.Qt.Orientation.Horizontal)

    def _warn(self, text: str) -> None:
        self.say(text, warning=True)

    def _end(self) -> None:
        """Forget everything that outlives the panel's widgets; only the first call does something."""
        global _current  # noqa: PLW0603
        if not self.is_open:
            return
        self.is_open = False
        if _current is self:
            _current = None
        FreeCAD.removeDocumentObserver(self._observer)
        with failures_told(self.title):
            self.discard()

    def _follow(self) -> None:
        """Catch up with the document once FreeCAD is done with what it is doing."""
        if self.is_open and not self._refresh_is_due:
            self._refresh_is_due = True
            QtCore.QTimer.singleShot(0, self._catch_up)

    def _catch_up(self) -> None:
        self._refresh_is_due = False
        if not self.is_open:
            return
        if self._document_name not in FreeCAD.listDocuments():
            self.close()
            return
        document = self.document
        if any(document.getObject(name) is None for name in self._needed):
            FreeCAD.Console.PrintMessage(f"{self.title}: {tr('closed, for what it worked on was deleted')}\n")
            self.close()
            return
        # what the panel said last stays readable
        with failures_told(self.title, self._warn):
            self.refresh()


class _Observer:
    """Tells a panel that its document was changed by others; the methods' names are FreeCAD's."""

    def __init__(self, panel: Panel) -> None:
        self._panel = panel

    def slotUndoDocument(self, document: Any) -> None:
        self._changed(document)

    def slotRedoDocument(self, document: Any) -> None:
        self._changed(document)

    def slotCreatedObject(self, obj: Any) -> None:
        self._changed(obj.Document)

    def slotDeletedObject(self, obj: Any) -> None:
        self._changed(obj.Document)

    def slotRecomputedDocument(self, document: Any) -> None:
        self._changed(document)

    def slotDeletedDocument(self, document: Any) -> None:
        self._changed(document)

    def _changed(self, document: Any) -> None:
        if document.Name == self._panel._document_name:  # noqa: SLF001  # one module
            self._panel._follow()  # noqa: SLF001


class _Keys(QtCore.QObject):  # type: ignore[misc]  # Qt has no types here
    """Takes Esc before FreeCAD closes the panel on it."""

    def __init__(self, form: Any, step_back: Callable[[], bool]) -> None:
        super().__init__(form)
        self._step_back = step_back
        form.installEventFilter(self)

    def eventFilter(self, watched: Any, event: Any) -> bool:  # Qt's name
        """Stop Esc where there was a step to take back."""
        if event.type() == QtCore.QEvent.Type.KeyPress and event.key() == ESCAPE:
            return self._step_back()
        return bool(super().eventFilter(watched, event))


def _number(button: Any) -> int:
    """Return a standard button as FreeCAD takes it: PySide2's enumerations are numbers, PySide6's have a value."""
    return int(getattr(button, "value", button))


def _message_label() -> Any:
    label = QtWidgets.QLabel()
    label.setWordWrap(True)
    label.setTextInteractionFlags(QtCore.Qt.TextInteractionFlag.TextSelectableByMouse)
    label.setObjectName("message")
    label.hide()
    return label


def _may_close(panel: Panel) -> bool:
    """Ask whether a panel may be closed, where that would lose something."""
    if not panel.has_result():
        return True
    text = tr("'{panel}' has results that are not applied. Close it without applying them?").format(panel=panel.title)
    answer = QtWidgets.QMessageBox.question(FreeCADGui.getMainWindow(), "Pipe Workbench", text)
    return bool(answer == QtWidgets.QMessageBox.StandardButton.Yes)
