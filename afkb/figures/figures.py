"""How likely things are in rooms, beside each other and on supports, with the counts behind it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Iterator
from pathlib import Path

from afkb.errors import KnowledgeError
from afkb.figures.counts import ANY_ROOM, Counts
from afkb.figures.figure import Figure, InRoom, OnSupport, Rate, Together
from afkb.figures.files import read_counts
from afkb.figures.pooling import (
    joined_names,
    number_where_any,
    rate_anywhere,
    weighted_sum,
    what_is_behind,
)
from afkb.figures.smoothing import (
    PAIR_WEIGHT,
    ROOM_WEIGHT,
    SUPPORT_WEIGHT,
    beta_mean,
    dirichlet_means,
    gamma_mean,
    general_rate,
    odds_shifted,
)
from afkb.figures.totals import Totals, totals_of

SUPPORT_ORDER = ("procthor", "virtualhome")
"""Who is asked for supports, first to last: ProcTHOR counts, VirtualHome lists what is possible."""


class Figures:
    """Smoothed figures from counts.

    Rooms and pairs are pooled over the real homes that were counted room by room, and only over
    sources that have a name for the categories asked for. Where those have no such room, sources
    that count viewpoints tell by what odds ratio it differs from any room; one sum of rooms and
    viewpoints makes both worse (`python -m bench.figures`), so `rooms_first` is the default.
    Simulated homes are apart: ask `figures.of("bddl")`. Supports are told by simulated homes only,
    so these answer there.
    """

    def __init__(
        self,
        counts: Counts,
        sources: Collection[str] | None = None,
        room_weight: float = ROOM_WEIGHT,
        pair_weight: float = PAIR_WEIGHT,
        rooms_first: bool = True,
    ) -> None:
        self.counts = counts
        real = [name for name, source in counts.sources.items() if source.real]
        self._chosen = sorted(real if sources is None else sources)
        totals = totals_of(counts)
        self._totals = [totals[name] for name in self._chosen if name in totals]
        self._asked = None if sources is None else tuple(self._chosen)
        self._room_weight, self._pair_weight = room_weight, pair_weight
        self._rooms_first = rooms_first

    @classmethod
    def load(cls, folder: Path) -> Figures:
        """The figures from a folder that `afkb ontology count` wrote."""
        return cls(read_counts(folder))

    def without(self, buildings: Collection[str]) -> Figures:
        """The figures in which these buildings have no part."""
        return self._with(self.counts.without(buildings))

    def plus(self, other: Figures) -> Figures:
        """The figures of both, as if counted together."""
        return self._with(self.counts.plus(other.counts))

    def of(self, *sources: str) -> Figures:
        """The figures of these sources alone."""
        return self._with(self.counts.of(sources), sources)

    def rooms(self) -> list[str]:
        """The room categories of which there are rooms."""
        return sorted({r for t in self._totals for r in t.rooms if r != ANY_ROOM})

    def categories(self) -> list[str]:
        """The categories of which a source has a name."""
        return sorted({c for t in self._totals for c in t.source.categories})

    def object_in_room(self, category: str, room: str) -> Figure:
        """P(a room of this category holds a thing of the category): Beta about the rate anywhere.

        Raises `KnowledgeError` for a category of which no source has a name.
        """
        totals = self._telling(category, lambda t: t.rooms[room])
        successes = weighted_sum(totals, lambda t: t.holding[room, category])
        trials = weighted_sum(totals, lambda t: t.rooms[room])
        anywhere = rate_anywhere(totals, category)
        p = beta_mean(successes, trials, anywhere, self._room_weight)
        whole = self._whole_behind(totals, category)
        if whole:
            p = odds_shifted(rate_anywhere(whole, category), p, anywhere)
        return Figure(p, successes, trials, *what_is_behind(totals, room, whole))

    def base_rate(self, category: str) -> float:
        """P(a room, of whatever category, holds a thing of the category)."""
        return rate_anywhere(self._telling(category, lambda t: t.named_rooms), category)

    def number_in_room(self, category: str, room: str) -> Rate:
        """Mean number of the category's things in a room: Gamma-Poisson about the mean anywhere.

        Where viewpoints answer, P(it holds one) times how many a room has that holds one.
        """
        totals = self._telling(category, lambda t: t.rooms[room])
        things = weighted_sum(totals, lambda t: t.things[room, category])
        rooms = weighted_sum(totals, lambda t: t.rooms[room])
        anywhere = weighted_sum(totals, lambda t: t.named_things[category]) + 0.5
        mean = anywhere / (weighted_sum(totals, lambda t: t.named_rooms) + 1)
        smoothed = gamma_mean(things, rooms, mean, self._room_weight)
        whole = self._whole_behind(totals, category)
        if whole:
            smoothed = self.object_in_room(category, room).p * number_where_any(whole, category)
        return Rate(smoothed, things, rooms, *what_is_behind(totals, room, whole))

    def object_with_object(self, category: str, given: str) -> Figure:
        """P(a room that holds the given category holds the other): Beta about the rate anywhere.

        A pair that few buildings hold isn't kept and has no successes; nor are pairs with what is
        in most rooms, of which the rate anywhere is told, without trials.
        """
        self._knowing(given)
        paired = [t for t in self._knowing(category) if {category, given} <= t.paired]
        told = self._first(paired, lambda t: t.holding_anywhere[given])
        totals = told or self._first(self._knowing(category), lambda t: t.rooms.total())
        anywhere = general_rate(
            weighted_sum(totals, lambda t: t.holding_anywhere[category]),
            weighted_sum(totals, lambda t: t.rooms.total()),
        )
        pair = (min(category, given), max(category, given))
        successes = weighted_sum(told, lambda t: t.pairs[pair])
        trials = weighted_sum(told, lambda t: t.holding_anywhere[given])
        p = beta_mean(successes, trials, anywhere, self._pair_weight)
        buildings = sum(t.buildings_holding[given] for t in told)
        return Figure(p, successes, trials, buildings, joined_names(t.source.name for t in totals))

    def support_of(self, thing: str) -> dict[str, Figure]:
        """P(it stands on a thing of that category | where the thing is put), likeliest first.

        Over all supports that the source knows; they sum to 1. Dirichlet about the shares of all
        things. Raises `KnowledgeError` where no source tells what the thing is put on.
        """
        source = next(
            (s for s in self._support_sources() if (s, thing) in self.counts.supports), ""
        )
        if not source:
            raise KnowledgeError(f"no counts tell what a {thing} stands on; ask another category")
        counts = self.counts.supports[source, thing]
        means = dirichlet_means(counts, self._shares(source), SUPPORT_WEIGHT)
        trials = sum(counts.values())
        ordered = sorted(means, key=lambda support: (-means[support], support))
        return {s: Figure(means[s], counts.get(s, 0), trials, 0, source) for s in ordered}

    def in_rooms(self, least: float = 1) -> Iterator[InRoom]:
        """Every category in every room category where at least so many rooms hold it."""
        for room in self.rooms():
            for category in self.categories():
                figure = self.object_in_room(category, room)
                if figure.successes >= least:
                    yield InRoom(category, room, figure, self.number_in_room(category, room))

    def together(self, least: float = 1) -> Iterator[Together]:
        """Every ordered pair of categories that at least so many rooms hold both."""
        pairs = {pair for t in self._totals for pair in t.pairs}
        for category, given in sorted(pairs | {(b, a) for a, b in pairs}):
            figure = self.object_with_object(category, given)
            if figure.successes >= least:
                yield Together(category, given, figure)

    def supports(self, least: float = 1) -> Iterator[OnSupport]:
        """Every thing with every support on which it was put at least so often."""
        sources = self._support_sources()
        for thing in sorted({t for s, t in self.counts.supports if s in sources}):
            for support, figure in self.support_of(thing).items():
                if figure.successes >= least:
                    yield OnSupport(thing, support, figure)

    def _with(self, counts: Counts, sources: Collection[str] | None = None) -> Figures:
        asked = self._asked if sources is None else sources
        return Figures(counts, asked, self._room_weight, self._pair_weight, self._rooms_first)

    def _telling(self, category: str, trials: Callable[[Totals], int]) -> list[Totals]:
        return self._first([t for t in self._knowing(category) if t.named_rooms], trials)

    def _first(self, totals: list[Totals], trials: Callable[[Totals], int]) -> list[Totals]:
        """Those that count rooms, if they have trials; else those that count parts, if they do."""
        if not self._rooms_first:
            return totals
        whole = [t for t in totals if t.source.weight == 1]
        parts = [t for t in totals if t.source.weight < 1]
        return next((some for some in (whole, parts) if any(map(trials, some))), whole or parts)

    def _knowing(self, category: str) -> list[Totals]:
        totals = [t for t in self._totals if category in t.source.categories]
        if not totals:
            named = ", ".join(self._chosen) or "nothing"
            raise KnowledgeError(
                f"no counted source ({named}) has a name for {category!r}; count homes that hold it"
            )
        return totals

    def _whole_behind(self, telling: list[Totals], category: str) -> list[Totals]:
        """Who counted whole rooms with such things, where viewpoints tell; else nobody."""
        if not self._rooms_first or any(t.source.weight == 1 for t in telling):
            return []
        return [t for t in self._knowing(category) if t.named_rooms and t.source.weight == 1]

    def _support_sources(self) -> tuple[str, ...]:
        return self._asked or SUPPORT_ORDER

    def _shares(self, source: str) -> dict[str, float]:
        total: Counter[str] = Counter()
        for (name, _), supports in self.counts.supports.items():
            if name == source:
                total.update(supports)
        return {support: number / total.total() for support, number in total.items()}
