"""How many things of a kind a room of some purpose holds, and how likely any."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

from afkb.finding.stated import rates_by_room

if TYPE_CHECKING:
    from afkb.knowledge import AfNet


@dataclass(frozen=True, slots=True)
class Holding:
    """P(a room holds at least one), and how many more than one on average where it does."""

    probability: float
    more: float

    def overlooked(self, share: float) -> float:
        """P(one is there | none was found), if a look overlooks that share of them."""
        p = self.probability
        return p * share / (1.0 - p + p * share) if p * share > 0 else 0.0

    def another(self, share: float) -> float:
        """P(one more is there, overlooked | one was found)."""
        return -math.expm1(-self.more * share)


@lru_cache(maxsize=256)
def holding(category: str, kb: AfNet) -> Mapping[str, Holding]:
    """By room category, of things of that category itself, none of its kinds.

    Who labels scans of homes names furniture and seldom small things: of mugs 35 in 171 homes. So
    the counts tell by how much kinds of rooms differ, and the ontology's expected number in a home
    how many there are in all.
    """
    probability, number = rates_by_room(category, kb)
    home = sum(kb.rooms[room].expected_number * mean for room, mean in number.items())
    scale = kb.categories[category].expected_number / home if home > 0 else 0.0
    return {
        room: Holding(
            1.0 - (1.0 - min(probability[room], 1.0 - 1e-9)) ** scale,
            max(number[room] / probability[room] - 1.0, 0.0) if probability[room] > 0 else 0.0,
        )
        for room in kb.rooms
    }


def any_of(kinds: Iterable[str], kb: AfNet) -> dict[str, Holding]:
    """By room category, of things of any of the kinds: independent, the room's purpose given."""
    found = [holding(kind, kb) for kind in kinds]
    together = {}
    for room in kb.rooms:
        parts = [h[room] for h in found]
        p = 1.0 - math.prod(1.0 - h.probability for h in parts)
        number = sum(h.probability * (1.0 + h.more) for h in parts)
        together[room] = Holding(p, max(number / p - 1.0, 0.0) if p > 0 else 0.0)
    return together


def numbers(category: str, kb: AfNet) -> dict[str, float]:
    """How many of that category a room holds on average, by room category."""
    return {room: h.probability * (1.0 + h.more) for room, h in holding(category, kb).items()}
