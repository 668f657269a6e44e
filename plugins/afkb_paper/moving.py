"""What became of things that were there and then not: they must not hold on to the map."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from afkb.flow import Entity, NodeKind, OrientedBox, TopologicalMap
from afkb_paper.judged import Judged
from afkb_paper.outlines import outline
from afkb_paper.steps import Steps

NEAR_M = 0.3
LEAST_TOP_M = 0.05
"""What is lower is the floor that the thing stood on."""
GONE_BELOW = 0.5
"""A node that less likely exists than not says that nothing is there."""


@dataclass(frozen=True, slots=True)
class Moved:
    """A thing that was taken away during the tour, and what the map made of it.

    - `matching_weight`: of its node while it was there; None where it had none.
    - `left`: ids of nodes that say at the end that it is still there.
    - `off_m`: farthest that the robot was placed off the truth after it had gone, m.
    """

    name: str
    matching_weight: float | None
    left: tuple[str, ...]
    off_m: float


def moved_things(judged: Judged, steps: Steps) -> Iterator[Moved]:
    """Each thing of the truth that did not stay until the end."""
    for thing in judged.truth.things:
        if math.isinf(thing.until):
            continue
        box, then = judged.box(thing), steps.until(thing.until)
        nodes = nodes_at(then, box)
        after = [off for view, off, _ in judged.views() if view.stamp > thing.until]
        yield Moved(
            thing.name,
            min((e.matching_weight for e in nodes), default=None),
            tuple(e.id for e in nodes_at(judged.found, box) if e.existence >= GONE_BELOW),
            max(after, default=math.nan),
        )


def nodes_at(found: TopologicalMap, box: OrientedBox) -> list[Entity]:
    """Observed nodes that stand where a box is, none much higher."""
    import shapely

    around = outline(box).buffer(NEAR_M)
    return [
        e
        for e in found.entities
        if e.kind is NodeKind.OBSERVED
        and around.contains(shapely.Point(e.position_xyz[:2]))
        and LEAST_TOP_M < e.top_m < box.top + NEAR_M
    ]
