"""The demo's result beside the paper's figures (paper §III, Fig. 2)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from afkb.flow import Closure, EdgeKind, NodeKind, TopologicalMap


@dataclass(frozen=True, slots=True)
class Row:
    """One line of the table: what, the paper's figure, ours."""

    what: str
    paper: str
    ours: str


def demo_results(topological_map: TopologicalMap) -> list[Row]:
    """The rows, from the map alone: the simulated world's truth is not looked at."""
    visited = [r for r in topological_map.rooms if r.visited]
    best = [max(r.belief, key=lambda name: r.belief[name]) for r in visited]
    duals = [c for c in topological_map.closures if c.predicted_as is NodeKind.DUAL]
    hidden = "; ".join(
        f"{c.entity} at p = {c.predicted_probability:.2f}, then seen from {c.place}" for c in duals
    )
    return [
        Row("rooms visited", "4", str(len(visited))),
        Row("place nodes", "6", str(len(topological_map.places))),
        Row("transient nodes per place", "about 3", f"{new_transients(topological_map):.1f}"),
        Row("hidden support predicted, then confirmed", "kitchen table", hidden or "none"),
        Row("expected to seen, m", "about 0", _merging_error(duals)),
        Row("room categories", "4/4 right", ", ".join(sorted(best))),
    ]


def new_transients(topological_map: TopologicalMap) -> float:
    """Things that may move, for each place: what a place adds to the graph on average."""
    dynamic = sum(e.movability == "Dynamic" for e in topological_map.entities)
    return dynamic / max(1, len(topological_map.places))


def transient_per_place(topological_map: TopologicalMap) -> float:
    """Things that may move, seen from a place, on average over the places."""
    dynamic = {e.id for e in topological_map.entities if e.movability == "Dynamic"}
    links = [e for e in topological_map.edges if e.kind is EdgeKind.OBSTACLE]
    return sum(e.target in dynamic for e in links) / max(1, len(topological_map.places))


def _merging_error(closures: Sequence[Closure]) -> str:
    """How far what was predicted by duality lay from where it then was seen."""
    errors = [c.displacement_m for c in closures]
    return f"{max(errors):.2f}" if errors else "no loop closed"
