"""What the ontology states of how often rooms hold things, and of what things are put on."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping
from functools import lru_cache
from typing import TYPE_CHECKING

from afkb.figures.smoothing import ROOM_WEIGHT

if TYPE_CHECKING:
    from afkb.knowledge import AfNet
    from afkb.knowledge.stated_figures import ObjectInRoom


@lru_cache(maxsize=256)
def rates_by_room(category: str, kb: AfNet) -> tuple[Mapping[str, float], Mapping[str, float]]:
    """P(a room holds any) and the mean number in it, of things of a category, by room category.

    What nothing is stated of is as the nearest broader category; where neither is, alike in every
    room, so that a home holds as many as expected. Rooms that were counted in which none was
    found are as unlikely as smoothing has it; rooms that nobody counted are as the mean.
    """
    rooms = {name: room.expected_number for name, room in kb.rooms.items()}
    stated = _in_rooms(kb)
    name = next((kind for kind in kb.kinds_of(category) if kind in stated), None)
    if name is None:
        mean = kb.categories[category].expected_number / max(sum(rooms.values()), 1.0)
        return dict.fromkeys(rooms, min(mean, 1.0)), dict.fromkeys(rooms, mean)
    told, counted = stated[name], _counted(kb)
    found = sum(figure.successes for figure in told.values())
    anywhere = (found + 0.5) / (sum(counted.values()) + 1.0)
    p = {room: anywhere * ROOM_WEIGHT / (n + ROOM_WEIGHT) for room, n in counted.items()}
    p |= {room: figure.probability for room, figure in told.items()}
    each = sum(f.mean_number for f in told.values()) / sum(f.probability for f in told.values())
    number = {room: max(1.0, each) * q for room, q in p.items()}
    number |= {room: max(f.mean_number, f.probability) for room, f in told.items()}
    known = [room for room in rooms if room in counted]
    weight = max(sum(rooms[room] for room in known), 1e-9)
    mean_p, mean_n = (sum(rooms[r] * of[r] for r in known) / weight for of in (p, number))
    return {r: p.get(r, mean_p) for r in rooms}, {r: number.get(r, mean_n) for r in rooms}


@lru_cache(maxsize=8)
def supports_of(kb: AfNet) -> Mapping[str, Mapping[str, float]]:
    """By category, the shares of its things that are put on each category of supports.

    What is stated leaves goes to the supports of which only other things are stated, as those are
    spread over them.
    """
    shares: defaultdict[str, dict[str, float]] = defaultdict(dict)
    for figure in kb.objects_on_supports:
        if figure.given in kb.categories and figure.category in kb.categories:
            shares[figure.given][figure.category] = figure.probability
    general: defaultdict[str, float] = defaultdict(float)
    for stated in shares.values():
        for support, p in stated.items():
            general[support] += p
    return {name: _filled(stated, general) for name, stated in shares.items()}


def _filled(stated: Mapping[str, float], general: Mapping[str, float]) -> Mapping[str, float]:
    others = {support: p for support, p in general.items() if support not in stated}
    rest, total = max(1.0 - sum(stated.values()), 0.0), sum(others.values())
    return {**stated, **{s: rest * p / total for s, p in others.items() if total > 0}}


@lru_cache(maxsize=8)
def _in_rooms(kb: AfNet) -> Mapping[str, Mapping[str, ObjectInRoom]]:
    stated: defaultdict[str, dict[str, ObjectInRoom]] = defaultdict(dict)
    for figure in kb.objects_in_rooms:
        if figure.probability > 0:
            stated[figure.category][figure.room] = figure
    return dict(stated)


@lru_cache(maxsize=8)
def _counted(kb: AfNet) -> Mapping[str, float]:
    """How many rooms of each category were counted."""
    counted: defaultdict[str, float] = defaultdict(float)
    for figure in kb.objects_in_rooms:
        counted[figure.room] = max(counted[figure.room], figure.trials)
    return dict(counted)
