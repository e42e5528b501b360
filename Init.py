# SPDX-License-Identifier: LGPL-2.1-or-later
"""Run by FreeCAD at start-up, with and without a window: finds the addon's Python packages."""

from pathlib import Path

import FreeCAD

import pipeworkbench
from pipeworkbench.environment import use_environment

use_environment(Path(pipeworkbench.__file__).resolve().parent.parent)

# for FreeCAD's File > Export, where the type that is chosen says which exporter of an ending is meant
FreeCAD.addExportType("Table of pipes and fittings (*.csv)", "pipeworkbench.features.table_export")
FreeCAD.addExportType("IFC of pipes and fittings (*.ifc)", "pipeworkbench.features.table_export")
