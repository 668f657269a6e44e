"""Sums over the sources that tell of a category, and what to call them."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable

from afkb.figures.smoothing import general_rate
from afkb.figures.totals import Totals


def weighted_sum(totals: Collection[Totals], count: Callable[[Totals], int]) -> float:
    """The counts of all sources, each by what one of its rooms is worth."""
    return sum(t.source.weight * count(t) for t in totals)


def rate_anywhere(totals: Collection[Totals], category: str) -> float:
    """P(a room, of whatever category, holds a thing of the category)."""
    return general_rate(
        weighted_sum(totals, lambda t: t.named_holding[category]),
        weighted_sum(totals, lambda t: t.named_rooms),
    )


def number_where_any(totals: Collection[Totals], category: str) -> float:
    """How many of the category's things a room has on average that holds one."""
    holding = weighted_sum(totals, lambda t: t.named_holding[category])
    return (weighted_sum(totals, lambda t: t.named_things[category]) + 0.5) / (holding + 0.5)


def what_is_behind(
    totals: Collection[Totals], room: str, whole: Collection[Totals] = ()
) -> tuple[int, str]:
    """How many buildings have such rooms, and whose they are."""
    about = f", about the rate of {joined_names(t.source.name for t in whole)}" if whole else ""
    buildings = sum(t.buildings_with[room] for t in totals)
    return buildings, joined_names(t.source.name for t in totals) + about


def joined_names(sources: Iterable[str]) -> str:
    """The sources by name, as in `hm3d + matterport`."""
    return " + ".join(sorted(sources))
