# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pipes become a pipeline: what lies between and at the ends of pipes is found, and all of it fitted together.

Reducers, then tees, then elbows, then caps, each at the ends that are still free; flanges come with the
pipes, so that no elbow is looked for where one sits. Pipes end where their fittings begin; a pipe between two elbows runs from
corner to corner, so that axes meet and joints are without a kink.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from pipeworkbench.pipeline import AnyComponent, Joint
from pipeworkbench.recon import caps, elbows, reducers, tees
from pipeworkbench.recon.fitting import Assembly, with_caps, with_elbows, with_flanges, with_reducers, with_tees
from pipeworkbench.recon.topology import TopologySettings, graph_of, join
from pipeworkbench.recon.views import View


@dataclass(frozen=True)
class AssembleSettings:
    """Tunables of each step."""

    reducers: reducers.ReducerSettings = field(default_factory=reducers.ReducerSettings)
    tees: tees.TeeSettings = field(default_factory=tees.TeeSettings)
    elbows: elbows.ElbowSettings = field(default_factory=elbows.ElbowSettings)
    caps: caps.CapSettings = field(default_factory=caps.CapSettings)
    topology: TopologySettings = field(default_factory=TopologySettings)


@dataclass(frozen=True)
class Completed:
    """Components with what was found between them, their joints, and what does not fit, in sentences."""

    components: tuple[AnyComponent, ...]
    joints: tuple[Joint, ...]
    warnings: tuple[str, ...]


def complete(
    views: Sequence[View], components: Sequence[AnyComponent], settings: AssembleSettings | None = None, station: str | None = None
) -> Completed:
    """Find reducers, tees, elbows and caps of pipes, set the pipes' ends to them and join everything.

    Parameters
    ----------
    views : sequence of View
    components : sequence of Component
        Pipes, and what is known already (flanges, fittings), in the station's frame.
    settings : AssembleSettings, optional
    station : str, optional
        Its name begins the new components' ids; default: the station of the first component.

    Returns
    -------
    Completed
        The given components first, in their order, then the new ones.
    """
    settings = settings or AssembleSettings()
    name = station or next((c.station for c in components if c.station), None)
    components = with_flanges(components)
    assembly = Assembly(components, joined_ends(components, settings.topology), name)
    assembly = with_reducers(assembly, reducers.detect(views, assembly.components, settings.reducers, assembly.taken))
    assembly = with_tees(assembly, tees.detect(views, assembly.components, settings.tees, assembly.taken))
    assembly = with_elbows(assembly, elbows.detect(views, assembly.components, settings.elbows, assembly.taken))
    assembly = with_caps(assembly, caps.detect(views, assembly.components, settings.caps, assembly.taken))
    graph = graph_of(assembly.components, settings=settings.topology)
    return Completed(assembly.components, graph.joints, graph.warnings)


def joined_ends(components: Sequence[AnyComponent], settings: TopologySettings | None = None) -> frozenset[tuple[int, int]]:
    """Return the ends (row, port) that meet already."""
    rows = {component.id: row for row, component in enumerate(components)}
    joints = join(components, settings)
    return frozenset(end for j in joints for end in ((rows[j.a], int(j.a_port)), (rows[j.b], int(j.b_port))))
