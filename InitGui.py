# SPDX-License-Identifier: LGPL-2.1-or-later
"""Run by FreeCAD's window at start-up: registers the workbench; everything else is loaded when it is used."""

import FreeCADGui

from pipeworkbench.workbench import PipeWorkbench

FreeCADGui.addWorkbench(PipeWorkbench())
