"""What nobody has seen: how likely a room holds such a thing, and where in the room it would be."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from afkb.finding.holding import Holding, any_of
from afkb.finding.putting import Putting, putting
from afkb.finding.surroundings import Node, RoomNode

if TYPE_CHECKING:
    from afkb.knowledge import AfNet

ELSEWHERE = ""
"""Stands for the room itself where other names are those of nodes."""
UNKNOWN = {"UnknownRoom": 1.0}
FLAT_M = 0.03
"""What is lower is not told from what it lies on: three times the step of a depth camera at 2 m,
about 11 mm."""


@dataclass(frozen=True, slots=True)
class Unseen:
    """Things of a category, its kinds included, that nobody has seen.

    `held`: what rooms hold, by room category. `put`: what such things are put on, None of what
    stands on the floor or hangs. `flat`: whether a look doesn't find them where they lie.
    """

    held: Mapping[str, Holding]
    put: Putting | None
    flat: bool
    kb: AfNet

    @classmethod
    def of(cls, category: str, kinds: list[str], kb: AfNet) -> Unseen:
        """Those of a category; a group is put on things as its commonest kind is."""
        commonest = max(kinds, key=lambda k: (kb.categories[k].expected_number, k))
        low, high = kb.categories[commonest].height_m
        put = putting(category if category in kinds else commonest, kb)
        return cls(any_of(kinds, kb), put, (low + high) / 2 < FLAT_M, kb)

    def places(
        self, room: RoomNode | None, nodes: list[Node], recognised: float
    ) -> dict[str, float]:
        """P(one is there) by node that carries things, and `ELSEWHERE`; independent of each other.

        `recognised`: P(one of those that were seen in the room is one).
        """
        none, shares = 1.0, defaultdict[str, float](float)
        weights = {n.id: self.put.weight(n, self.kb) for n in nodes} if self.put else {}
        weights = {name: weight for name, weight in weights.items() if weight > 0}
        carrying = [node for node in nodes if node.id in weights]
        for purpose, p in (room.belief if room else UNKNOWN).items():
            left = self._left(purpose, room, carrying, weights) if purpose in self.held else {}
            missed = sum(left.values())
            if not missed > 0:
                continue
            held = self.held[purpose]
            u = (1 - recognised) * held.overlooked(missed) + recognised * held.another(missed)
            none -= p * u
            for name, share in left.items():
                shares[name] += p * u * share / missed
        whole = sum(shares.values())
        if not whole > 0:
            return {}
        log_none = math.log(max(none, 1e-9))
        return {name: -math.expm1(log_none * s / whole) for name, s in shares.items() if s > 0}

    def probability(self, belief: Mapping[str, float]) -> float:
        """P(a room of that posterior holds one)."""
        return sum(
            p * self.held[room].probability for room, p in belief.items() if room in self.held
        )

    def _left(
        self,
        purpose: str,
        room: RoomNode | None,
        carrying: list[Node],
        weights: Mapping[str, float],
    ) -> dict[str, float]:
        """Of a room's things of the kind, the share that is at each place and was overlooked."""
        looks = room.viewpoints if room else 0
        if self.put is None:
            return {ELSEWHERE: 1.0 - (0.0 if self.flat else self.found(looks))}
        other = self.put.unseen(purpose, self.kb) * (1.0 - self.found(looks))
        total = sum(weights.values()) + other
        if not total > 0:
            return {}
        left = {n.id: weights[n.id] * self._overlooked(n) / total for n in carrying}
        return left | {ELSEWHERE: other / total}

    def _overlooked(self, node: Node) -> float:
        """Share of the things on or in a node that was overlooked; a closed one hides all."""
        open_ = node.supports or node.affords.get("ContainAbility", 0.0) > 0.5
        return 1.0 if self.flat or not open_ else 1.0 - self.found(node.viewpoints)

    def found(self, viewpoints: int) -> float:
        """Share of things that so many viewpoints find: each finds half of those that are left.

        Never more than a good look around does.
        """
        half = self.kb.parameters["ShareSeenHalf"]
        return min(1.0 - (1.0 - half) ** viewpoints, self.kb.parameters["ShareSeenMost"])
