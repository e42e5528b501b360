# SPDX-License-Identifier: LGPL-2.1-or-later
"""STEP: the solids with their names and colours, in millimetres."""

from __future__ import annotations

from pathlib import Path

from pipeworkbench.errors import InputError, PipeWorkbenchError
from pipeworkbench.exports.kinds import COLOURS
from pipeworkbench.files import written_whole
from pipeworkbench.pipeline import Pipeline
from pipeworkbench.solids import component_solid


def write_step(pipeline: Pipeline, path: Path) -> None:
    """Write an AP214 file with one named solid per component, coloured by its kind.

    Raises
    ------
    InputError
        Where the pipeline holds nothing that could be written.
    """
    if not pipeline.components:
        raise InputError(path, "", "the pipeline has no components", "reconstruct some first")
    solids = [(component, component_solid(component)) for component in pipeline.components]
    import cadquery

    assembly = cadquery.Assembly(name=pipeline.frame)
    for component, solid in solids:
        assembly.add(solid, name=component.id, color=cadquery.Color(*COLOURS[type(component)]))
    with written_whole(path) as temporary:
        # the exporter takes the format from its argument, not from the name
        if not cadquery.exporters.assembly.exportAssembly(assembly, str(temporary)):
            raise PipeWorkbenchError(f"{path}: the STEP file could not be written; check the space on the disk")
