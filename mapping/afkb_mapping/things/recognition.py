"""What things are, told by their surroundings too: room, support, and boards over each other."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from shapely import STRtree
from shapely.geometry import Polygon

from afkb.flow import Entity, NodeKind
from afkb.inference import Network
from afkb.inference.recognition import CountsOf, is_floor, standing_together

BOARDS_APART_M = 0.10
"""Boards of one thing are so far apart at least; nearer surfaces are one, seen twice."""
SAME_OUTLINE = 0.6
"""Intersection over union from which on two surfaces over each other have one outline; each is seen
through what stands on it and in part hidden by the one above."""


def recognised(entities: Sequence[Entity], counts_of: CountsOf, network: Network) -> list[Entity]:
    """The entities with their categories told by room and support, and boards put together.

    What stands on each other is told together; of the room counts what else is in it (§II.F).
    """
    entities = _boards_of_one_thing(entities)
    told = {e.id: e for e in entities}
    for together in standing_together(entities, counts_of, network):
        shares = network.joint.recognise(together.things, together.room).shares
        for entity, share in zip(together.entities, shares.tolist(), strict=True):
            belief = dict(zip(network.objects.categories, share, strict=True))
            movability, weight = network.movability(belief)
            told[entity.id] = replace(
                entity, category_belief=belief, movability=movability, matching_weight=weight
            )
    return list(told.values())


def _boards_of_one_thing(entities: Sequence[Entity]) -> list[Entity]:
    """Surfaces of one outline over each other are parts of the topmost one's thing."""
    surfaces = [
        e
        for e in entities
        if e.kind is NodeKind.OBSERVED
        and e.affords("SupportAbility")
        and not is_floor(e)
        and e.polygon_xy is not None
        and len(e.polygon_xy) > 2
    ]
    outlines = [Polygon(e.polygon_xy).buffer(0) for e in surfaces]
    tree = STRtree(outlines)
    top_of: dict[str, Entity] = {}
    for e, outline in zip(surfaces, outlines, strict=True):
        over = [
            surfaces[i]
            for i in tree.query(outline, predicate="intersects").tolist()
            if surfaces[i].top_m > e.top_m + BOARDS_APART_M and _alike(outline, outlines[i])
        ]
        if over:
            top_of[e.id] = max(over, key=lambda other: (other.top_m, other.id))
    return [replace(e, part_of=top_of[e.id].id) if e.id in top_of else e for e in entities]


def _alike(one: Polygon, other: Polygon) -> bool:
    shared = one.intersection(other).area
    return bool(shared >= SAME_OUTLINE * (one.area + other.area - shared))
