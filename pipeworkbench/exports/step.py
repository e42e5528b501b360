# SPDX-License-Identifier: LGPL-2.1-or-later
"""STEP: the solids of pipework and insulation as an assembly with names and colours, in millimetres.

The assembly is called as the pipeline's frame. It holds "Pipework", with one node for each run and its components in it,
and, where insulation is planned, "Insulation", with one node for each covering and its layers and jacket in it. Every part
is modelled in its own axes and placed in the assembly. No two names are alike, because programs number those that are: components
have their ids, coverings theirs (with "insulation" behind where a component is called so, too), bodies begin with their covering's.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pipeworkbench.errors import InputError, MissingPackageError, PipeWorkbenchError
from pipeworkbench.exports.kinds import COLOURS, Colour, material_colour
from pipeworkbench.files import written_whole
from pipeworkbench.insulation.runs import runs_of
from pipeworkbench.pipeline import Pipeline, free_id
from pipeworkbench.solids import Frame, frame_of, local_solid
from pipeworkbench.solids.coverings import AnyCovering
from pipeworkbench.solids.insulation import CoveringBody, covering_bodies

if TYPE_CHECKING:
    from pipeworkbench.insulation.planning import Plan

PIPEWORK, INSULATION, JACKET = "Pipework", "Insulation", "jacket"


def write_step(pipeline: Pipeline, path: Path, plan: Plan | None = None) -> None:
    """Write an AP214 file of a pipeline's components and of what a plan of its insulation covers them with.

    Raises
    ------
    InputError
        Where the pipeline holds nothing that could be written, or a component's dimensions make no solid.
    MissingPackageError
        Where CadQuery, which brings Open CASCADE, is not installed.
    """
    if not pipeline.components:
        raise InputError(path, "", "the pipeline has no components", "reconstruct some first")
    here = {component.id for component in pipeline.components}
    coverings = [piece.covering for piece in plan.pieces if piece.covering.component in here] if plan else []
    assembly = _Assembly(pipeline.frame, here)
    assembly.pipework(pipeline)
    if coverings:
        assembly.insulation(coverings)
    with written_whole(path) as temporary:
        if not assembly.write(temporary):
            raise PipeWorkbenchError(f"{path}: the STEP file could not be written; check the space on the disk")


class _Assembly:
    """An assembly in Open CASCADE's document of shapes with attributes (XCAF); what it holds does not take ``names``, the components'."""

    def __init__(self, name: str, names: Iterable[str]) -> None:
        self.ocp = _open_cascade()
        document = self.ocp.TDocStd.TDocStd_Document(self._text("XmlOcaf"))
        self.ocp.XCAFApp.XCAFApp_Application.GetApplication_s().InitDocument(document)
        tool = self.ocp.XCAFDoc.XCAFDoc_DocumentTool
        self.document, self.shapes, self.colours = document, tool.ShapeTool_s(document.Main()), tool.ColorTool_s(document.Main())
        # names are ours, not what the kind of shape is called
        self.shapes.SetAutoNaming_s(False)
        self.used = set(names)
        self.root = self._named(self.shapes.NewShape(), self._free(name))

    def pipework(self, pipeline: Pipeline) -> None:
        """Add a pipeline's components under the runs they belong to, both in the pipeline's order."""
        runs = runs_of(pipeline)
        nodes: dict[str, Any] = {}
        top = self._node(self.root, self._free(PIPEWORK))
        for component in pipeline.components:
            frame, run = frame_of(component), runs[component.id]
            if run not in nodes:
                nodes[run] = self._node(top, self._free(f"Run {run}"))
            self._part(nodes[run], component.id, local_solid(component, frame), COLOURS[type(component)], frame)

    def insulation(self, coverings: Iterable[AnyCovering]) -> None:
        """Add the bodies of coverings, each under its covering."""
        top = self._node(self.root, self._free(INSULATION))
        for covering in coverings:
            name = f"{covering.id} {INSULATION.lower()}" if covering.id in self.used else covering.id
            node = self._node(top, self._free(name), covering.frame)
            for body in covering_bodies(covering):
                self._part(node, self._free(f"{covering.id} {body.name}"), body.solid, _colour_of(body))

    def write(self, path: Path) -> bool:
        """Write the STEP file; return whether that went well."""
        self.shapes.UpdateAssemblies()
        # without a session of its own the writer would add to what the last one wrote
        writer = self.ocp.STEPCAFControl.STEPCAFControl_Writer(self.ocp.XSControl.XSControl_WorkSession(), False)
        writer.SetColorMode(True)
        writer.SetNameMode(True)
        writer.Transfer(self.document, self.ocp.STEPControl.STEPControl_StepModelType.STEPControl_AsIs)
        done = writer.Write(str(path))
        return bool(done == self.ocp.IFSelect.IFSelect_ReturnStatus.IFSelect_RetDone)

    def _free(self, wished: str) -> str:
        """Return a name that nothing has yet."""
        name = free_id(wished, self.used)
        self.used.add(name)
        return name

    def _node(self, parent: Any, name: str, frame: Frame | None = None) -> Any:
        """Add an assembly to another and return it."""
        node = self._named(self.shapes.NewShape(), name)
        self._placed(parent, node, name, frame)
        return node

    def _part(self, parent: Any, name: str, solid: Any, colour: Colour, frame: Frame | None = None) -> None:
        """Add a solid in its own axes to an assembly."""
        part = self._named(self.shapes.NewShape(), name)
        self.shapes.SetShape(part, solid.wrapped)
        quantity = self.ocp.Quantity
        shown = quantity.Quantity_Color(*colour, quantity.Quantity_TypeOfColor.Quantity_TOC_sRGB)
        self.colours.SetColor(part, shown, self.ocp.XCAFDoc.XCAFDoc_ColorType.XCAFDoc_ColorSurf)
        self._placed(parent, part, name, frame)

    def _placed(self, parent: Any, child: Any, name: str, frame: Frame | None) -> None:
        """Put a part or an assembly into another one, where a frame says."""
        self._named(self.shapes.AddComponent(parent, child, self._location(frame)), name)

    def _location(self, frame: Frame | None) -> Any:
        if frame is None:
            return self.ocp.TopLoc.TopLoc_Location()
        motion = self.ocp.gp.gp_Trsf()
        motion.SetValues(*(value for row in frame.matrix[:3] for value in row))
        return self.ocp.TopLoc.TopLoc_Location(motion)

    def _named(self, label: Any, name: str) -> Any:
        self.ocp.TDataStd.TDataStd_Name.Set_s(label, self._text(name))
        return label

    def _text(self, text: str) -> Any:
        return self.ocp.TCollection.TCollection_ExtendedString(text.encode("utf-8", "replace").decode(), True)  # in UTF-8


def _open_cascade() -> Any:
    """Import Open CASCADE late: it takes seconds and only STEP needs its documents."""
    try:
        import OCP.gp
        import OCP.IFSelect
        import OCP.Quantity
        import OCP.STEPCAFControl
        import OCP.STEPControl
        import OCP.TCollection
        import OCP.TDataStd
        import OCP.TDocStd
        import OCP.TopLoc
        import OCP.XCAFApp
        import OCP.XCAFDoc
        import OCP.XSControl
    except ImportError:
        raise MissingPackageError("CadQuery", "Writing STEP", "pip install 'cadquery>=2.4,<2.9'") from None
    return OCP


def _colour_of(body: CoveringBody) -> Colour:
    return material_colour(body.material, jacket=body.name.startswith(JACKET))
