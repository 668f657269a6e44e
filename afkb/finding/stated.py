"""What the ontology states of how often rooms hold things, and of what things are put on."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping
from functools import lru_cache
from statistics import fmean
from typing import TYPE_CHECKING

from afkb.figures.smoothing import ROOM_WEIGHT

if TYPE_CHECKING:
    from afkb.knowledge import AfNet
    from afkb.knowledge.stated_figures import ObjectInRoom


@lru_cache(maxsize=256)
def rates_by_room(category: str, kb: AfNet) -> tuple[Mapping[str, float], Mapping[str, float]]:
    """P(a room holds any) and the mean number in it, of things of a category, by room category.

    What nothing is stated of is as the nearest broader category of which something is, else as
    others of its group are on average; where there is no such, alike in every room.
    """
    stated = _in_rooms(kb)
    kinds = kb.kinds_of(category)
    told = next(([kind] for kind in kinds if kind in stated), [])
    for group in kinds[1:]:
        told = told or [name for name in stated if group in kb.kinds_of(name)]
    if not told:
        rooms = sum(room.expected_number for room in kb.rooms.values())
        mean = kb.categories[category].expected_number / max(rooms, 1.0)
        return dict.fromkeys(kb.rooms, min(mean, 1.0)), dict.fromkeys(kb.rooms, mean)
    rates = [_rates(stated[name], kb) for name in told]
    return (
        {room: fmean(p[room] for p, _ in rates) for room in kb.rooms},
        {room: fmean(n[room] for _, n in rates) for room in kb.rooms},
    )


def _rates(
    told: Mapping[str, ObjectInRoom], kb: AfNet
) -> tuple[Mapping[str, float], Mapping[str, float]]:
    """P(any) and mean number by room category, of what is stated of one category.

    Rooms that were counted in which none was found are as unlikely as smoothing has it; rooms that
    nobody counted are as the mean.
    """
    rooms = {name: room.expected_number for name, room in kb.rooms.items()}
    counted = _counted(kb)
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
