# SPDX-License-Identifier: LGPL-2.1-or-later
"""The shape of an Insulation object: one compound for each piece, modelled once and kept as long as the piece is the same."""

from __future__ import annotations

import contextlib
import dataclasses
import hashlib
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import FreeCAD
import Part

from pipeworkbench.errors import InputError, PipeWorkbenchError
from pipeworkbench.solids import brep_text
from pipeworkbench.solids.coverings import AnyCovering

if TYPE_CHECKING:
    from pipeworkbench.insulation.planning import Piece

Progress = Callable[[str, int, int], None]

DIGITS = 6  # of mm and of direction cosines that a piece's shape depends on; files keep more
ELSEWHERE = frozenset({"id", "component", "components", "frame", "seam"})  # of a covering: no part of its shape in its own axes
MODELS_KEPT = 2048  # pieces of the session, for what moves as a whole, is undone or pasted


def model(obj: Any, pieces: Sequence[Piece]) -> tuple[list[Piece], list[PipeWorkbenchError]]:
    """Give an object the shapes of pieces; only those that are not there already are modelled. Return those that could be."""
    present = dict(zip(obj.PieceKeys, obj.Shape.SubShapes, strict=False)) if not obj.Shape.isNull() else {}
    shapes: dict[str, Any] = {}
    modelled, errors = [], []
    for piece in pieces:
        key = _key(piece.covering)
        try:
            shapes[key] = present.get(key) or shape_of(piece.covering)
        except PipeWorkbenchError as error:
            errors.append(error)
        else:
            modelled.append(piece)
    if list(shapes) != list(obj.PieceKeys) or obj.Shape.isNull():
        obj.Shape = Part.makeCompound(list(shapes.values())) if shapes else Part.Shape()
        obj.PieceKeys = list(shapes)
    return modelled, errors


_models: dict[str, str] = {}  # BREP of what was modelled, in its own axes


def model_ahead(coverings: Sequence[AnyCovering], progress: Progress) -> None:
    """Model coverings, in a thread, too, so that their shapes are there at once when objects ask for them; those that cannot be are left out."""
    for number, covering in enumerate(coverings):
        progress(f"modelling the insulation of {covering.component}", number, len(coverings))
        with contextlib.suppress(InputError):
            _brep(covering)


def shape_of(covering: AnyCovering) -> Any:
    """Return the bodies of a covering as one compound (Part.Shape), in place.

    Raises
    ------
    InputError
        Where its dimensions make no bodies.
    MissingPackageError
        Where CadQuery is not installed.
    """
    shape = Part.Shape()
    shape.importBrepFromString(_brep(covering))
    shape.Placement = FreeCAD.Placement(FreeCAD.Matrix(*(value for row in covering.frame.matrix for value in row)))
    return shape


def _brep(covering: AnyCovering) -> str:
    from pipeworkbench.solids.insulation import covering_bodies

    key = _digest(_content(covering))
    text = _models.pop(key, None)
    if text is None:
        bodies = covering_bodies(covering)  # says what is missing where CadQuery is
        from cadquery import Compound

        text = brep_text(Compound.makeCompound([body.solid for body in bodies]))
    _models[key] = text  # the last used is the last to go
    if len(_models) > MODELS_KEPT:
        del _models[next(iter(_models))]
    return text


def _key(covering: AnyCovering) -> str:
    frame = covering.frame
    return _digest([covering.id, _content(covering), *map(_plain, (frame.origin, frame.x, frame.y, frame.z))])


def _content(covering: AnyCovering) -> list[Any]:
    """Return what the shape of a covering depends on in its own axes."""
    names = (field.name for field in dataclasses.fields(covering) if field.name not in ELSEWHERE)
    return [covering.kind, *(_plain(getattr(covering, name)) for name in names)]


def _plain(item: Any) -> Any:
    """Return numbers as they are told apart, without minus zero."""
    if isinstance(item, float):
        return round(item, DIGITS) + 0.0
    if dataclasses.is_dataclass(item):
        return [_plain(getattr(item, field.name)) for field in dataclasses.fields(item)]
    if isinstance(item, tuple | list):
        return [_plain(part) for part in item]
    return _plain(item.tolist()) if hasattr(item, "tolist") else item


def _digest(item: Any) -> str:
    return hashlib.sha1(repr(item).encode(), usedforsecurity=False).hexdigest()
