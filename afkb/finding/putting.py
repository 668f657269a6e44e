"""What a thing of some kind is put on: how likely on each support, one as it is seen or unseen."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from statistics import fmean
from typing import TYPE_CHECKING

from afkb.finding.holding import numbers
from afkb.finding.stated import supports_of

if TYPE_CHECKING:
    from afkb.finding.surroundings import Node
    from afkb.knowledge import AfNet

NO_FURNITURE = ("Structure", "Wall")
"""What is built in or hangs; it carries things only where that was counted."""


@dataclass(frozen=True, slots=True)
class Putting:
    """How a home's things of a category are spread over its supports.

    `rates`: support category to the share of the things that one support of it carries: the share
    on all of them over their number in a home. `unlisted`: of a support of any other category.
    """

    rates: Mapping[str, float]
    unlisted: float

    def weight(self, node: Node, kb: AfNet) -> float:
        """Share of a home's things of the kind that a node carries, by what it may be."""
        return node.existence * sum(
            p * self._rate(name, node.supports, kb) for name, p in node.belief.items()
        )

    def unseen(self, purpose: str, kb: AfNet) -> float:
        """The same of all supports that a room of that purpose has on average."""
        return sum(rate * numbers(name, kb)[purpose] for name, rate in self.rates.items())

    def _rate(self, name: str, supports: bool, kb: AfNet) -> float:
        """That of the category or of what is broader; of its group; of any support."""
        if name in self.rates:
            return self.rates[name]
        if not supports or name not in kb.categories:
            return 0.0
        if kb.categories[name].stands_on in NO_FURNITURE:
            return 0.0
        broader = kb.kinds_of(name)[1:]
        for kind in broader:
            alike = [r for s, r in self.rates.items() if kind in kb.kinds_of(s)]
            if alike:
                return fmean(alike)
        return self.unlisted


@lru_cache(maxsize=256)
def putting(category: str, kb: AfNet) -> Putting | None:
    """Where a home's things of a category are put; None of what stands on the floor or hangs.

    As counted on supports; where nobody counted it, as the counted ones of its group are, else as
    all of its scale are.
    """
    stands_on = kb.categories[category].stands_on
    if stands_on not in ("Support", "Anything"):
        return None
    shares = _shares(category, kb)
    if not shares:
        return None
    number = {s: max(kb.categories[s].expected_number, 1e-3) for s in shares}
    rates = {s: share / number[s] for s, share in shares.items()}
    return Putting(rates, sum(shares.values()) / sum(number.values()))


def _shares(category: str, kb: AfNet) -> dict[str, float]:
    for name in kb.kinds_of(category):
        if name in supports_of(kb):
            return dict(supports_of(kb)[name])
    for group in kb.kinds_of(category)[1:]:
        alike = [shares for name, shares in supports_of(kb).items() if group in kb.kinds_of(name)]
        if alike:
            return _mean(alike)
    scale = kb.categories[category].scale
    return _mean([s for name, s in supports_of(kb).items() if kb.categories[name].scale == scale])


def _mean(several: list[Mapping[str, float]]) -> dict[str, float]:
    total: defaultdict[str, float] = defaultdict(float)
    for shares in several:
        for support, p in shares.items():
            total[support] += p / len(several)
    return dict(total)
