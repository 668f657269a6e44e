"""What the things of a map are, told by their surroundings: what the joint network makes of them.

It takes from the entities no more than a map states of them, so that a stored map gives the same.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from afkb.flow import Entity, NodeKind
from afkb.inference.joint import SeenThing
from afkb.inference.network import Network
from afkb.inference.placement import FLOOR, NOWHERE, SUPPORT

CountsOf = Callable[[str | None], Mapping[str, int]]
"""Room id to the counts of evidence classes in it; None is of no room."""


@dataclass(frozen=True, slots=True)
class Together:
    """Entities that stand on each other, as the network takes them in, and what the room is for.

    `room`: by what else is in it; their own affordances would count twice (paper §II.F).
    """

    entities: tuple[Entity, ...]
    things: tuple[SeenThing, ...]
    room: Mapping[str, float]


def standing_together(
    entities: Sequence[Entity], counts_of: CountsOf, network: Network
) -> Iterator[Together]:
    """Observed things but the floor: each with what stands on it, what carries comes first."""
    all_of = {e.id: e for e in entities}
    for group in _groups(entities):
        things = tuple(_seen_things(group, all_of, network))
        yield Together(tuple(group), things, _room_without(group, counts_of, network))


def evidence_of(entity: Entity, network: Network) -> tuple[str, ...]:
    """Names of the evidence classes that a thing counts for in its room."""
    known = network.known(entity.affordances)
    return network.evidence_of(known, entity.size_xyz, entity.top_m)


def _groups(entities: Sequence[Entity]) -> Iterator[list[Entity]]:
    known = {e.id: e for e in entities if e.kind is NodeKind.OBSERVED and not is_floor(e)}
    together: dict[str, list[Entity]] = defaultdict(list)
    for e in known.values():
        lowest, passed = e, {e.id}
        while lowest.supported_by in known and lowest.supported_by not in passed:
            lowest = known[lowest.supported_by]
            passed.add(lowest.id)
        together[lowest.id].append(e)
    for root, group in together.items():
        yield sorted(group, key=lambda e: e.id != root)


def _seen_things(
    together: Sequence[Entity], all_of: Mapping[str, Entity], network: Network
) -> Iterator[SeenThing]:
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
        return FLOOR if is_floor(below) else SUPPORT
    return None if below is not None or entity.affords("SupportAbility") else NOWHERE


def _room_without(
    together: Sequence[Entity], counts_of: CountsOf, network: Network
) -> dict[str, float]:
    counts = Counter(counts_of(together[0].room))
    for e in together:
        if e.room == together[0].room:
            for name in evidence_of(e, network):
                counts[name] -= counts[name] > 0
    return network.room_posterior(counts)


def is_floor(entity: Entity) -> bool:
    """Whether it is the floor, which no network infers."""
    return set(entity.category_belief) == {"Floor"}
