"""All that a page needs of a map: the plan, what is known of each node, and when it was known."""

from __future__ import annotations

from dataclasses import dataclass

from afkb.drawing.facts import Json, facts_of
from afkb.drawing.plan import plan
from afkb.drawing.times import times_of
from afkb.flow import NodeKind, TopologicalMap


@dataclass(frozen=True, slots=True, eq=False)
class Drawing:
    """A map, drawn.

    - `svg`: the plan. `summary`: one line. `notes`: what the run wants a reader to know.
    - `nodes`: id to what is known of it, see `afkb.drawing.facts`.
    - `times`: when the map was made, see `afkb.drawing.times`.
    """

    svg: str
    summary: str
    nodes: dict[str, Json]
    times: Json
    notes: tuple[str, ...] = ()

    def as_json(self) -> Json:
        """`nodes` and `time`: everything but the plan, for a page that has it already."""
        return {"nodes": self.nodes, "time": self.times}


def drawing_of(topological_map: TopologicalMap) -> Drawing:
    """The map's drawing; the same for the same map, byte for byte."""
    return Drawing(
        plan(topological_map),
        summary(topological_map),
        facts_of(topological_map),
        times_of(topological_map),
        topological_map.notes,
    )


def summary(m: TopologicalMap) -> str:
    """What there is, in one line."""
    seen = sum(e.kind is NodeKind.OBSERVED for e in m.entities)
    counted = (
        (len(m.rooms), "room"),
        (len(m.places), "robot place"),
        (seen, "thing seen"),
        (len(m.entities) - seen, "thing predicted"),
        (len(m.closures), "loop closure"),
    )
    return " · ".join(f"{n} {_plural(what) if n != 1 else what}" for n, what in counted)


def _plural(what: str) -> str:
    return what.replace("thing", "things") if "thing" in what else f"{what}s"
