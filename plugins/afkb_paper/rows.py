"""The table: the paper's figure, ours, and how ours was obtained."""

from __future__ import annotations

import math
import statistics
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from afkb.flow import NodeKind, TopologicalMap
from afkb_mapping.demo_table import new_transients, transient_per_place
from afkb_paper.fetching import FETCHED, Fetched
from afkb_paper.hidden import Hidden
from afkb_paper.judged import Judged, return_errors
from afkb_paper.moving import Moved
from afkb_paper.rooms import AFFORDANCES, JudgedRoom
from afkb_paper.scenarios import Figures

BASELINE = "doors-and-walls"
"""The room classifier that stands in for the paper's [11]."""
UNTOLD = "–"
FROM_MAP, BY_TRUTH, PLANNED = "counted in the map", "against the truth", "planned on the map"


@dataclass(frozen=True, slots=True)
class Row:
    """One line of the table; `value` is what `ours` tells, for programs; `how`: how obtained."""

    key: str
    what: str
    paper: str
    ours: str
    how: str
    value: object


@dataclass(frozen=True, slots=True, eq=False)
class Outcome:
    """All that was measured on one scenario."""

    judged: Judged
    rooms: Sequence[JudgedRoom]
    hidden: Sequence[Hidden]
    moved: Sequence[Moved]
    fetched: Fetched | str


def rows(paper: Figures, outcome: Outcome) -> Iterator[Row]:
    """The table of a scenario, in the paper's order."""
    found = outcome.judged.found
    places = len(found.places)
    yield Row("places", "place nodes", str(paper.places), str(places), FROM_MAP, places)
    yield _transient(paper, found)
    yield _loop_error(paper, outcome.judged)
    yield _merged(outcome.judged)
    yield from _rooms(paper, outcome.rooms)
    yield _hidden(paper, outcome.hidden)
    yield _moved(paper, outcome.moved)
    yield _fetched(outcome.fetched)


def _transient(paper: Figures, found: TopologicalMap) -> Row:
    """Things that may move: those that a place adds to the graph, and those that are seen there."""
    what, told = "transient nodes per waypoint", paper.transient or UNTOLD
    new = round(new_transients(found), 1)
    seen = round(transient_per_place(found), 1)
    how = f"{FROM_MAP}: things that may move, over its places; mean in sight of one"
    value = {"new": new, "seen": seen}
    return Row("transient", what, told, f"{new} new ({seen} in sight)", how, value)


def _loop_error(paper: Figures, judged: Judged) -> Row:
    what, off = "loop error, m", return_errors(judged)
    how = f"{BY_TRUTH}: the robot's place, greatest of {len(off)} views in rooms it came back to"
    if not off:
        return Row("loop_error", what, paper.loop_m, "no room twice", how, None)
    greatest, mean = max(off), statistics.fmean(off)
    value = {"greatest": round(greatest, 4), "mean": round(mean, 4)}
    ours = f"{greatest:.2f} (mean {mean:.2f})"
    return Row("loop_error", what, paper.loop_m, ours, how, value)


def _merged(judged: Judged) -> Row:
    """How far expected nodes lay from what was then seen in their place."""
    what, duals = "node merging, m", NodeKind.DUAL
    off = sorted(c.displacement_m for c in judged.found.closures if c.predicted_as is duals)
    how = (
        f"{FROM_MAP}: {len(off)} expected by duality, then seen; from the one to the other, median"
    )
    if not off:
        return Row("merging", what, UNTOLD, "none came true", how, None)
    median = statistics.median(off)
    value = {"median": round(median, 4), "greatest": round(off[-1], 4)}
    ours = f"{median:.2f} (greatest {off[-1]:.2f})"
    return Row("merging", what, UNTOLD, ours, how, value)


def _rooms(paper: Figures, rooms: Sequence[JudgedRoom]) -> Iterator[Row]:
    for key, by, right, what in (
        ("rooms", AFFORDANCES, paper.rooms, "room categories right"),
        ("rooms_baseline", BASELINE, paper.baseline, "the same by doors and walls [11]"),
    ):
        ours = sum(room.is_right(by) for room in rooms)
        wrong = [f"{r.name}: {r.told(by)}" for r in rooms if not r.is_right(by)]
        how = BY_TRUTH + (f"; wrong: {', '.join(wrong)}" if wrong else "")
        value = {
            "right": ours,
            "of": len(rooms),
            "told": {r.name: {"is": r.category, "told": r.told(by)} for r in rooms},
        }
        told = f"{right}/{paper.rooms}"
        yield Row(key, what, told, f"{ours}/{len(rooms)}", how, value)


def _hidden(paper: Figures, hidden: Sequence[Hidden]) -> Row:
    value = [
        {
            "thing": h.thing.name,
            "probability": round(h.probability, 3),
            "off_m": round(h.off_m, 3),
            "ways": len(h.blind.ways),
            "through_without": h.blind.hits,
            "through_with": h.expecting.hits,
        }
        for h in hidden
    ]
    ways = "; ".join(
        f"{h.thing.name} (p {h.probability:.2f}): of {len(h.blind.ways)} ways past it "
        f"{h.blind.hits} lead through it without what is expected, {h.expecting.hits} with"
        for h in hidden
    )
    avoided, in_the_way = sum(h.avoided for h in hidden), sum(h.blind.hits > 0 for h in hidden)
    ours = f"{avoided} of {in_the_way}" if in_the_way else "none in the way"
    how = f"{PLANNED} of before it was seen" + (f"; {ways}" if ways else "")
    told = paper.hidden or UNTOLD
    return Row("hidden", "hidden obstacle avoided", told, ours, how, value)


def _moved(paper: Figures, moved: Sequence[Moved]) -> Row:
    entered = [m for m in moved if m.matching_weight is not None or m.left]
    told = "; ".join(
        f"{m.name}: weight {m.matching_weight or math.nan:.2f}, "
        + (f"still there as {', '.join(m.left)}" if m.left else "no node left")
        + f", robot off by {m.off_m:.2f} m at most after it had gone"
        for m in entered
    )
    gone = sum(not m.left for m in entered)
    ours = f"{gone} of {len(entered)} gone" if entered else "none was entered"
    how = BY_TRUTH + (f"; {told}" if told else "")
    value = [
        {
            "thing": m.name,
            "matching_weight": m.matching_weight and round(m.matching_weight, 3),
            "left": list(m.left),
            "off_m": None if math.isnan(m.off_m) else round(m.off_m, 4),
        }
        for m in moved
    ]
    return Row("dynamic", "dynamic thing ignored", paper.dynamic or UNTOLD, ours, how, value)


def _fetched(found: Fetched | str) -> Row:
    what, paper = "mug fetched from the hall", "shortest way to the kitchen"
    command = "`afkb route MAP --from LivingRoom --to mug`"
    if isinstance(found, str):
        return Row("mug", what, paper, "no route", f"{command}: {found}", None)
    kinds = " or ".join(sorted(FETCHED)).lower()
    if found.length_m is None or found.places is None:
        ours, how = "not found", f"{command}, {BY_TRUTH}: no {kinds} where it looks"
        return Row("mug", what, paper, ours, how, {"found": None})
    places = f"place {found.places}" if found.places > 1 else "the first place"
    ours = f"{found.length_m:.1f} m, in the {found.room}"
    how = f"{command}, {BY_TRUTH}: {places} it looks at has {found.thing}"
    value = {
        "found": found.thing,
        "length_m": round(found.length_m, 2),
        "places": found.places,
        "room": found.room,
    }
    return Row("mug", what, paper, ours, how, value)
