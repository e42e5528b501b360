# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the user has set for this workbench, checked at the door, and the settings of the reconstruction that follow from it.

The values live in FreeCAD's parameters; whoever needs one calls `preferences`. Nothing heavy is loaded for that.
"""

from __future__ import annotations

import functools
import json
import math
from collections.abc import Callable, Iterable
from dataclasses import Field, dataclass, field, fields, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import FreeCAD

from pipeworkbench.errors import InputError

if TYPE_CHECKING:
    from pipeworkbench.recon.adjust import AdjustmentSettings
    from pipeworkbench.recon.assemble import AssembleSettings
    from pipeworkbench.recon.detect import DetectSettings
    from pipeworkbench.recon.pick_settings import PickSettings

PREFERENCES = "User parameter:BaseApp/Preferences/Mod/PipeWorkbench"
CATALOGUE_FOLDER = "CatalogueFolder"  # one folder, of versions that knew only one
SOURCE = "Preferences"
SIZES = ("exact", "tolerance", "free")

Colour = tuple[float, float, float]


def _number(key: str, low: float, high: float) -> dict[str, Any]:
    return {"key": key, "low": low, "high": high}


def _choice(key: str, choices: tuple[str, ...]) -> dict[str, Any]:
    return {"key": key, "choices": choices}


def _colour(key: str) -> dict[str, Any]:
    return {"key": key, "colour": True}


@dataclass(frozen=True)
class Preferences:
    """The user's settings; lengths in mm unless their names say otherwise. The metadata of a field holds its key and its limits.

    Attributes
    ----------
    catalogue_folders : tuple of str
        Folders with tables of the user's own; what a later one holds takes the place of an earlier one's.
    nearest, farthest : float
        The working range: where pipes are looked for, as distances from the rig.
    smallest_diameter, largest_diameter : float
        Outside diameters that are looked for.
    size_tolerance_percent : float
        Deviation of a measured diameter from the standard's from which on a pipe is marked as approximate.
    snap_radius_px : float
        How near to an edge the pointer must be to snap to it, in pixels of the screen.
    joint_gap : float
        Distance up to which two ends that face each other are joined.
    outlier_limit : float
        Limit of Baarda's test in the adjustment: what is above is a gross error.
    sizes : str
        Whether the adjustment holds standard sizes exactly, within their tolerances, or not at all.
    aligned : bool
        Whether the adjustment takes pipes that are nearly level, plumb or at right angles to be so.
    pipe_colour, elbow_colour, ..., cap_colour : tuple of float
        Of the kinds of components in 3D: red, green, blue from 0 to 1.
    good_colour, fair_colour, poor_colour, bad_colour, unknown_colour, approximate_colour : tuple of float
        By quality, of what was not measured, and of pipes that the images do not support well.
    good_quality_px, fair_quality_px, poor_quality_px : float
        Quality (Eq. 4) up to which a component is coloured as good, fair or poor; beyond the last one it is bad.
    threads : int
        Threads that are used at most; 0 for all cores.
    """

    catalogue_folders: tuple[str, ...] = field(default=(), metadata={"key": "CatalogueFolders"})
    nearest: float = field(default=2000.0, metadata=_number("WorkingRangeNear", 300.0, 50_000.0))
    farthest: float = field(default=12_000.0, metadata=_number("WorkingRangeFar", 500.0, 100_000.0))
    smallest_diameter: float = field(default=10.0, metadata=_number("SmallestDiameter", 5.0, 3000.0))
    largest_diameter: float = field(default=2600.0, metadata=_number("LargestDiameter", 10.0, 5000.0))
    size_tolerance_percent: float = field(default=1.2, metadata=_number("SizeTolerancePercent", 0.1, 10.0))
    snap_radius_px: float = field(default=14.0, metadata=_number("SnapRadiusPx", 2.0, 60.0))
    joint_gap: float = field(default=10.0, metadata=_number("JointGap", 1.0, 200.0))
    outlier_limit: float = field(default=3.29, metadata=_number("OutlierLimit", 1.5, 10.0))
    sizes: str = field(default="exact", metadata=_choice("Sizes", SIZES))
    aligned: bool = field(default=False, metadata={"key": "Aligned"})
    pipe_colour: Colour = field(default=(0.55, 0.63, 0.70), metadata=_colour("ColourPipe"))
    elbow_colour: Colour = field(default=(0.44, 0.58, 0.72), metadata=_colour("ColourElbow"))
    flange_colour: Colour = field(default=(0.36, 0.42, 0.50), metadata=_colour("ColourFlange"))
    tee_colour: Colour = field(default=(0.47, 0.65, 0.60), metadata=_colour("ColourTee"))
    reducer_colour: Colour = field(default=(0.66, 0.61, 0.50), metadata=_colour("ColourReducer"))
    cap_colour: Colour = field(default=(0.60, 0.52, 0.58), metadata=_colour("ColourCap"))
    good_colour: Colour = field(default=(0.0, 0.62, 0.45), metadata=_colour("ColourGood"))
    fair_colour: Colour = field(default=(0.34, 0.71, 0.91), metadata=_colour("ColourFair"))
    poor_colour: Colour = field(default=(0.94, 0.89, 0.26), metadata=_colour("ColourPoor"))
    bad_colour: Colour = field(default=(0.84, 0.37, 0.0), metadata=_colour("ColourBad"))
    unknown_colour: Colour = field(default=(0.62, 0.62, 0.62), metadata=_colour("ColourUnknown"))
    approximate_colour: Colour = field(default=(0.90, 0.62, 0.0), metadata=_colour("ColourApproximate"))
    good_quality_px: float = field(default=0.3, metadata=_number("GoodQualityPx", 0.05, 10.0))
    fair_quality_px: float = field(default=0.6, metadata=_number("FairQualityPx", 0.1, 20.0))
    poor_quality_px: float = field(default=1.0, metadata=_number("PoorQualityPx", 0.1, 50.0))
    threads: int = field(default=0, metadata=_number("Threads", 0, 256))

    def __post_init__(self) -> None:
        for item in fields(self):
            _check(item, getattr(self, item.name))
        for low, high, what in RANGES:
            if getattr(self, low) >= getattr(self, high):
                raise _empty_range(low, what)

    def kind_colour(self, kind: str) -> Colour:
        """Return the colour of a kind of components, such as ``pipe``."""
        colour: Colour = getattr(self, f"{kind}_colour")
        return colour

    @property
    def quality_scale(self) -> tuple[tuple[float, Colour], ...]:
        """The upper limits of the qualities (Eq. 4, px) and their colours, from good to bad."""
        return (
            (self.good_quality_px, self.good_colour),
            (self.fair_quality_px, self.fair_colour),
            (self.poor_quality_px, self.poor_colour),
            (math.inf, self.bad_colour),
        )


FAR_PX = 6.0  # from this search distance on the starting values of an adjustment are rough ones
RANGES = (
    ("nearest", "farthest", "the working range is empty"),
    ("smallest_diameter", "largest_diameter", "the range of diameters is empty"),
    ("good_quality_px", "fair_quality_px", "the range of fair quality is empty"),
    ("fair_quality_px", "poor_quality_px", "the range of poor quality is empty"),
)
_told: set[str] = set()  # what was wrong in the parameters and has been said


def preferences() -> Preferences:
    """Return what the user has set; what does not fit is told once in the report view, and the default is used in its place."""
    return _parsed(tuple(FreeCAD.ParamGet(PREFERENCES).GetContents() or ()))


@functools.lru_cache(maxsize=1)
def _parsed(_contents: tuple[Any, ...]) -> Preferences:
    """Return the settings that the parameters hold now: those that ``_contents`` lists, and are not read anew until they change."""
    parameters = FreeCAD.ParamGet(PREFERENCES)
    values: dict[str, Any] = {}
    for item in fields(Preferences):
        value = _read(parameters, item)
        try:
            _check(item, value)
        except InputError as error:
            _tell(error)
        else:
            values[item.name] = value
    return Preferences(**_without_empty_ranges(values))


def save_preferences(chosen: Preferences) -> None:
    """Write settings to FreeCAD's parameters; defaults are not written, so that they can become better."""
    parameters = FreeCAD.ParamGet(PREFERENCES)
    for item in fields(Preferences):
        _write(parameters, item, getattr(chosen, item.name))
    parameters.RemString(CATALOGUE_FOLDER)


def key_of(name: str) -> str:
    """Return the parameter's key of a field."""
    return str(next(item.metadata["key"] for item in fields(Preferences) if item.name == name))


def pick_settings() -> PickSettings:
    """Return the settings of measuring pipes, in the user's working range, diameters and tolerance."""
    from pipeworkbench.recon.pick_settings import PickSettings

    chosen = preferences()
    return PickSettings(
        working_range=(chosen.nearest, chosen.farthest),
        diameter_range=(chosen.smallest_diameter, chosen.largest_diameter),
        tolerance=chosen.size_tolerance_percent / 100,
    )


def detect_settings() -> DetectSettings:
    """Return the settings of finding pipes without a click, in the user's working range.

    Of the user's diameters those are looked for that are not taken for pipes by mistake; all of them where there are none such.
    """
    from pipeworkbench.recon.detect import DetectSettings

    picked, basis = pick_settings(), DetectSettings()
    smallest, largest = (f(own, wished) for f, own, wished in zip((max, min), basis.diameter_range, picked.diameter_range, strict=True))
    diameters = (smallest, largest) if smallest < largest else picked.diameter_range
    return replace(basis, working_range=picked.working_range, diameter_range=diameters)


def adjustment_settings(reach: float | None = None) -> AdjustmentSettings:
    """Return the settings of the common adjustment.

    Parameters
    ----------
    reach : float, optional
        How far from the contours edges are looked for, px; where that is far, flanges may also lie elsewhere along their pipes.
    """
    from pipeworkbench.recon.adjust import AdjustmentSettings

    if reach is None:
        basis = AdjustmentSettings()
    else:
        basis = AdjustmentSettings.for_rough_values(reach) if reach > FAR_PX else AdjustmentSettings(ranges=(reach, 2.0))
    chosen = preferences()
    return replace(basis, sizes=chosen.sizes, aligned=chosen.aligned, snooping=chosen.outlier_limit)  # type: ignore[arg-type]  # checked


def assemble_settings() -> AssembleSettings:
    """Return the settings of putting components together."""
    from pipeworkbench.recon.assemble import AssembleSettings
    from pipeworkbench.recon.topology import TopologySettings

    gap = preferences().joint_gap
    topology = TopologySettings()
    return AssembleSettings(topology=replace(topology, gap_mm=gap, least_gap_mm=min(topology.least_gap_mm, gap)))


def use_preferences() -> None:
    """Use the user's tables and number of threads from now on; every command begins with this.

    Raises
    ------
    InputError
        Where a table does not fit; the catalogue in use stays.
    """
    from pipeworkbench.recon.threads import limit_threads

    use_preferred_catalogue()
    limit_threads(preferences().threads)


def use_preferred_catalogue() -> None:
    """Use the tables of the user's folders beside the standards'; none where there are none.

    They are read anew each time, for the user may have changed them.

    Raises
    ------
    InputError
        Where a table does not fit; the catalogue in use stays.
    """
    from pipeworkbench.catalogue import catalogue, use_folders

    folders = tuple(Path(name).expanduser() for name in preferences().catalogue_folders)
    if folders or catalogue().folders:
        use_folders(folders)


def start_with_preferred_catalogue() -> None:
    """Use the preferred tables; where they do not fit, say so and go on without: a document must open all the same."""
    try:
        use_preferred_catalogue()
    except InputError as error:
        FreeCAD.Console.PrintError(f"Pipe Workbench: {error}\n")


def _check(item: Field[Any], value: Any) -> None:
    """Refuse a value that does not fit its field."""
    limits, key = item.metadata, item.metadata["key"]
    if "choices" in limits and value not in limits["choices"]:
        raise InputError(SOURCE, key, f"there is no choice {value!r}", f"choose one of {', '.join(limits['choices'])}")
    if "low" in limits and not (math.isfinite(value) and limits["low"] <= value <= limits["high"]):
        raise InputError(SOURCE, key, f"{value:g} is out of range", f"choose a number from {limits['low']:g} to {limits['high']:g}")
    if "colour" in limits and not (len(value) == 3 and all(0 <= part <= 1 for part in value)):
        raise InputError(SOURCE, key, "is no colour", "choose another one")


def _without_empty_ranges(values: dict[str, Any]) -> dict[str, Any]:
    """Return the values without the limits of ranges that would be empty, which leaves these at their defaults."""
    defaults = Preferences()
    for low, high, what in RANGES:
        if values.get(low, getattr(defaults, low)) >= values.get(high, getattr(defaults, high)):
            _tell(_empty_range(low, what))
            # what is left may contradict the defaults that come in now
            return _without_empty_ranges({name: value for name, value in values.items() if name not in (low, high)})
    return values


def _empty_range(low: str, what: str) -> InputError:
    return InputError(SOURCE, key_of(low), f"{what}: the lower limit is not below the upper one", "correct one of the two")


def _tell(error: InputError) -> None:
    if str(error) not in _told:
        _told.add(str(error))
        FreeCAD.Console.PrintWarning(f"Pipe Workbench: {error}; the default is used\n")


def _read(parameters: Any, item: Field[Any]) -> Any:
    key: str = item.metadata["key"]
    default: Any = item.default
    if item.name == "catalogue_folders":
        return _folders(parameters.GetString(key, ""), parameters.GetString(CATALOGUE_FOLDER, ""))
    if "colour" in item.metadata:
        packed = parameters.GetUnsigned(key, _packed(default))
        return default if packed == _packed(default) else tuple((packed >> shift & 255) / 255 for shift in (24, 16, 8))
    return _ACCESS[type(default)][0](parameters)(key, default)


def _write(parameters: Any, item: Field[Any], value: Any) -> None:
    key = item.metadata["key"]
    kind: type = int if "colour" in item.metadata else str if item.name == "catalogue_folders" else type(item.default)
    if value == item.default:
        (parameters.RemUnsigned if "colour" in item.metadata else _ACCESS[kind][2](parameters))(key)
    elif "colour" in item.metadata:
        parameters.SetUnsigned(key, _packed(value))
    else:
        _ACCESS[kind][1](parameters)(key, json.dumps(value) if item.name == "catalogue_folders" else value)


_ACCESS: dict[type, tuple[Callable[[Any], Any], Callable[[Any], Any], Callable[[Any], Any]]] = {
    float: (lambda p: p.GetFloat, lambda p: p.SetFloat, lambda p: p.RemFloat),
    int: (lambda p: p.GetInt, lambda p: p.SetInt, lambda p: p.RemInt),
    bool: (lambda p: p.GetBool, lambda p: p.SetBool, lambda p: p.RemBool),
    str: (lambda p: p.GetString, lambda p: p.SetString, lambda p: p.RemString),
}


def _folders(listed: str, single: str) -> tuple[str, ...]:
    """Return the folders of the parameters: a JSON list, or the one folder of older versions."""
    try:
        names = json.loads(listed) if listed else [single] if single else []
    except json.JSONDecodeError:
        names = None
    if not isinstance(names, list) or not all(isinstance(name, str) and name for name in names):
        _tell(InputError(SOURCE, key_of("catalogue_folders"), "is no list of folders", "choose them anew"))
        return ()
    return tuple(names)


def _packed(colour: Iterable[float]) -> int:
    """Return a colour as FreeCAD's parameters hold it: red, green, blue, alpha of 8 bits each."""
    red, green, blue = (round(255 * part) for part in colour)
    return red << 24 | green << 16 | blue << 8 | 255
