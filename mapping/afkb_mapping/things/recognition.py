"""What things are, told by their surroundings too: room, support, and boards over each other."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace

from shapely import STRtree
from shapely.geometry import Polygon

from afkb.flow import Entity, NodeKind
from afkb.inference import Network, SeenThing
from afkb.inference.placement import FLOOR, NOWHERE, SUPPORT
from afkb_mapping.rooms.evidence import evidence_of

BOARDS_APART_M = 0.10
"""Boards of one thing are so far apart at least; nearer surfaces are one, seen twice."""
SAME_OUTLINE = 0.6
"""Intersection over union from which on two surfaces over each other have one outline; each is seen
through what stands on it and in part hidden by the one above."""

CountsOf = Callable[[str | None], Mapping[str, int]]
"""Room id to the counts of evidence classes in it; None is of no room."""


def recognised(entities: Sequence[Entity], counts_of: CountsOf, network: Network) -> list[Entity]:
    """The entities with their categories told by room and support, and boards put together.

    What stands on each other is told together; of the room counts what else is in it (§II.F).
    """
    entities = _boards_of_one_thing(entities)
    told = {e.id: e for e in entities}
    for together in _standing_together(entities):
        room = room_without(together, counts_of, network)
        shares = network.joint.recognise(list(seen_things(together, told, network)), room).shares
        for entity, share in zip(together, shares.tolist(), strict=True):
            belief = dict(zip(network.objects.categories, share, strict=True))
            movability, weight = network.movability(belief)
            told[entity.id] = replace(
                entity, category_belief=belief, movability=movability, matching_weight=weight
            )
    return list(told.values())


def seen_things(
    together: Sequence[Entity], all_of: Mapping[str, Entity], network: Network
) -> Iterator[SeenThing]:
    """Entities that stand on each other, as the network takes them in, in their order."""
    index = {e.id: i for i, e in enumerate(together)}
    whole = {e.part_of for e in all_of.values() if e.part_of}
    for e in together:
        yield SeenThing(
            network.known(e.affordances),
            e.size_xyz,
            e.top_m,
            e.extent_known,
            index.get(e.supported_by or ""),
            _stands(e, all_of),
            e.part_of is not None or e.id in whole,
        )


def _stands(entity: Entity, all_of: Mapping[str, Entity]) -> str | None:
    """On what it is seen to stand; of surfaces nobody looks for what carries them."""
    below = all_of.get(entity.supported_by or "")
    if below is not None and below.kind is NodeKind.OBSERVED:
        return FLOOR if _is_floor(below) else SUPPORT
    return None if below is not None or entity.affords("SupportAbility") else NOWHERE


def room_without(
    together: Sequence[Entity], counts_of: CountsOf, network: Network
) -> dict[str, float]:
    """What a room is for by what else is in it: things' own affordances count but once."""
    counts = Counter(counts_of(together[0].room))
    for e in together:
        if e.room == together[0].room:
            for name in evidence_of(e, network):
                counts[name] -= counts[name] > 0
    return network.room_posterior(counts)


def _standing_together(entities: Sequence[Entity]) -> Iterator[list[Entity]]:
    """Observed things but the floor: each with what stands on it, what carries comes first."""
    known = {e.id: e for e in entities if e.kind is NodeKind.OBSERVED and not _is_floor(e)}
    together: dict[str, list[Entity]] = defaultdict(list)
    for e in known.values():
        lowest = e
        while lowest.supported_by in known:
            lowest = known[lowest.supported_by]
        together[lowest.id].append(e)
    for root, things in together.items():
        yield sorted(things, key=lambda e: e.id != root)


def _is_floor(entity: Entity) -> bool:
    return set(entity.category_belief) == {"Floor"}


def _boards_of_one_thing(entities: Sequence[Entity]) -> list[Entity]:
    """Surfaces of one outline over each other are parts of the topmost one's thing."""
    surfaces = [
        e
        for e in entities
        if e.kind is NodeKind.OBSERVED
        and e.affords("SupportAbility")
        and not _is_floor(e)
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
