"""What things are, told by their surroundings too: room, support, and boards over each other."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import replace

from shapely import STRtree
from shapely.geometry import Polygon

from afkb.flow import Change, ChangeKind, Entity, NodeKind
from afkb.inference import Network
from afkb.inference.recognition import CountsOf, is_floor, standing_together
from afkb.inference.update_rules import against
from afkb_mapping.things.entities import EXISTS_FROM, SUSTAINED

BOARDS_APART_M = 0.10
"""Boards of one thing are so far apart at least; nearer surfaces are one, seen twice."""
SAME_OUTLINE = 0.6
"""Intersection over union from which on two surfaces over each other have one outline; each is seen
through what stands on it and in part hidden by the one above."""


Surrounding = Callable[[Sequence[Entity], CountsOf, Network], list[Entity]]
"""What tells how far things exist by their surroundings: the same entities, surer or less sure."""


def in_context(entities: Sequence[Entity], counts_of: CountsOf, network: Network) -> list[Entity]:
    """The entities, each as sure as its surroundings leave it.

    What stands on each other is told together; of the room counts what else is in it (§II.F).
    """
    told = {e.id: e for e in entities}
    for together in standing_together(entities, counts_of, network):
        context = network.joint.recognise(together.things, together.room).context
        for entity, ratio in zip(together.entities, context.tolist(), strict=True):
            told[entity.id] = _surrounded(entity, ratio)
    return list(told.values())


def recognised(
    entities: Sequence[Entity],
    counts_of: CountsOf,
    network: Network,
    surrounding: Surrounding = in_context,
) -> list[Entity]:
    """The entities with their categories told by room and support, and boards put together.

    `surrounding` says how far each exists where it is; what stays doubtful is left out.
    """
    entities = _boards_of_one_thing(entities)
    doubtful = {e.id for e in entities if not _is_sure(e)}
    told = surrounding(entities, counts_of, network)
    return _named(_still_there(told, doubtful), counts_of, network)


def _named(entities: Sequence[Entity], counts_of: CountsOf, network: Network) -> list[Entity]:
    """With the categories that the network tells of all that is there."""
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


def _surrounded(entity: Entity, ratio: float) -> Entity:
    """Its existence by its surroundings, too: both ways, table and book (paper §II.C).

    They tell whether it was there when it was seen. What time has left of that they leave.
    """
    before, left = entity.existence, _left_by_time(entity)
    now = against(before / left, ratio) * left
    weighed = ratio if left == 1.0 else now * (1.0 - before) / (before * (1.0 - now))
    step = Change(ChangeKind.SURROUNDED, weighed, before, now, entity.last_seen)
    return replace(entity, existence=now, history=(*entity.history, step))


def _left_by_time(entity: Entity) -> float:
    """Share that time has left of its existence since anything else told of it."""
    left = 1.0
    for change in reversed(entity.history):
        if change.kind is not ChangeKind.AGED:
            break
        left *= change.evidence
    return left


def _still_there(entities: Sequence[Entity], doubtful: Collection[str]) -> list[Entity]:
    """Without what was and stays doubtful, and without what followed from that alone.

    What was sure by itself stays, less sure: what carries it may not have been in view yet.
    """
    observed = [e for e in entities if e.kind is NodeKind.OBSERVED]
    gone = {e.id for e in observed if e.id in doubtful and not _is_sure(e)}
    kept = []
    for e in entities:
        anchors = tuple(a for a in e.predicted_from if a not in gone)
        if e.id in gone or (e.kind is not NodeKind.OBSERVED and e.predicted_from and not anchors):
            continue
        on = None if e.supported_by in gone else e.supported_by
        whole = None if e.part_of in gone else e.part_of
        kept.append(replace(e, predicted_from=anchors, supported_by=on, part_of=whole))
    return kept


def _is_sure(entity: Entity) -> bool:
    seen = entity.observations > 1 or entity.existence >= SUSTAINED
    return is_floor(entity) or (entity.existence >= EXISTS_FROM and seen)


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
