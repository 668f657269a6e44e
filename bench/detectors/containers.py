"""Containers: small hollow and closed things, and large ones such as tubs and sinks.

A view sees a thing well where `SEEN_WELL_PIXELS` of it show. A thing counts as found where two
views claim it, or one if no other sees it well. A claim is right where its centre lies in a
container's box; over two views or more, claims that lie on none and within `SAME_PLACE_M` of each
other are one false thing.
"""

from __future__ import annotations

import statistics
from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from typing import Any

import numpy as np

from afkb.flow import Detection
from bench.detectors.data import Asked, Home
from bench.detectors.in_sight import pixels_in_sight
from bench.detectors.seen import CLAIMED, Run, described

NEEDS = ("homes",)
SEEN_WELL_PIXELS = 600
HOLLOW = ("mug", "bowl", "cups", "pitcher")
CLOSED = ("box", "can", "bottle", "cleanser")
LARGE_CONTAINERS = ("basket", "trash_can", "bathtub", "sink", "toilet")
KINDS = ("hollow", "closed", "large")
BESIDE_M = 0.04
SAME_PLACE_M = 0.15
VIEWS = 2
CLOSED_SHARE = 0.5
"""What is as likely closed as not is taken for closed."""
Claim = tuple[int, Detection]


def run(asked: Asked) -> dict[str, Any]:
    """The score of each home by its name, and of all of them."""
    homes = {h.name: scored(h) for h in asked.homes}
    return {"homes": homes, "all": {k: _pooled([h[k] for h in homes.values()]) for k in KINDS}}


def table(result: dict[str, Any]) -> Iterator[str]:
    for name, home in result["homes"].items():
        for kind in KINDS:
            yield f"{name}: {_line(kind, home[kind])}"
            for r in home[kind]["things"]:
                yield (
                    f"    {r['name']:26} {r['most_pixels']:6d} px, claims {r['claimed']}: "
                    f"{r['claimed_well']} of {r['seen_well']} that see it well; closed in "
                    f"{r['as_closed']}, top {r['top_error']}{'' if r['found'] else '  MISSED'}"
                )
        for kind in KINDS:
            for wrong in home[kind]["wrong"]:
                yield f"    wrong, {kind}: {wrong}"
    for kind in KINDS:
        yield f"all: {_line(kind, result['all'][kind])}"


def _line(kind: str, s: dict[str, Any]) -> str:
    return (
        f"{kind} over {VIEWS} views: recall {s['recall']:.2f} of {s['seen_well']}, precision "
        f"{s['precision']:.2f}; by view: recall {s['view_recall']:.2f} of {s['view_seen_well']}, "
        f"precision {s['view_precision']:.2f} of {s['view_claims']}"
    )


def kind_of(thing: dict[str, Any]) -> str | None:
    """`hollow`, `closed`, `large`, or None for what isn't a container."""
    category = thing["category"]
    small = max(np.array(thing["max"]) - np.array(thing["min"])) < 0.4 and category[:3].isdigit()
    if small and any(word in category for word in HOLLOW):
        return "hollow"
    if small and any(category.endswith(word) for word in CLOSED):
        return "closed"
    return "large" if category in LARGE_CONTAINERS else None


def scored(home: Home) -> dict[str, dict[str, Any]]:
    """The score of one home."""
    containers = [t for t in home.truth["things"] if kind_of(t)]
    return score(home.seen, home.truth, pixels_in_sight(home.views(), containers))


def score(
    run: Run, truth: dict[str, Any], in_sight: dict[str, dict[int, int]]
) -> dict[str, dict[str, Any]]:
    """By kind: recall and precision over two views and by view, each thing, what was wrong."""
    hits: dict[str, list[Claim]] = defaultdict(list)
    wrong: dict[str, list[Claim]] = defaultdict(list)
    right: dict[str, int] = defaultdict(int)
    for index, d in run.of("ContainAbility"):
        thing = thing_at(d, truth["things"])
        kind = kind_of(thing) if thing else None
        claimed = _claimed_kind(d)
        if thing is None or kind is None or (claimed == "hollow" and kind == "closed"):
            wrong[claimed].append((index, d))
        else:
            hits[thing["name"]].append((index, d))
            right["large" if kind == "large" else claimed] += 1
    looked_at = {index for index, _ in run.views}
    return {
        kind: _scored(
            [_row(t, hits[t["name"]], in_sight.get(t["name"], {}), looked_at)
             for t in truth["things"]
             if kind_of(t) == kind and t["most_pixels"] >= SEEN_WELL_PIXELS],
            right[kind], wrong[kind],
        )
        for kind in KINDS
    }  # fmt: skip


def _claimed_kind(d: Detection) -> str:
    """What a claim takes its thing for; what is let into a surface or stands wide is large."""
    closed = d.affordances.get("IntrinsicContainAbility", 0.0)
    if closed >= CLOSED_SHARE * d.affordances["ContainAbility"]:
        return "closed"
    return "large" if max(d.box.size_xyz) >= 0.3 else "hollow"


def _row(
    thing: dict[str, Any], hits: Sequence[Claim], in_sight: dict[int, int], looked_at: set[int]
) -> dict[str, Any]:
    """How often a thing was claimed, and whether that counts as found."""
    views = {index for index, _ in hits}
    well = {i for i, n in in_sight.items() if n >= SEEN_WELL_PIXELS and i in looked_at}
    return {
        "name": thing["name"],
        "most_pixels": thing["most_pixels"],
        "seen_well": len(well),
        "claimed": len(views),
        "claimed_well": len(views & well),
        "as_closed": sum(d.affords("IntrinsicContainAbility", CLAIMED) for _, d in hits),
        "top_error": _median(d.box.top - thing["max"][2] for _, d in hits),
        "found": len(views) >= max(1, min(VIEWS, len(well))),
    }


def _scored(rows: list[dict[str, Any]], right: int, wrong: Sequence[Claim]) -> dict[str, Any]:
    """The score of one kind of container from its things, and from the claims of that kind."""
    places = false_places(wrong)
    counts = {
        "things": rows,
        "wrong": places,
        "seen_well": len(rows),
        "found": sum(r["found"] for r in rows),
        "false": len(places),
        "view_seen_well": sum(r["seen_well"] for r in rows),
        "view_found": sum(r["claimed_well"] for r in rows),
        "view_claims": right + len(wrong),
        "view_right": right,
    }
    return counts | _shares(counts)


def _shares(n: dict[str, Any]) -> dict[str, float]:
    return {
        "recall": n["found"] / max(n["seen_well"], 1),
        "precision": n["found"] / max(n["found"] + n["false"], 1),
        "view_recall": n["view_found"] / max(n["view_seen_well"], 1),
        "view_precision": n["view_right"] / max(n["view_claims"], 1),
    }


def _pooled(scores: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """The same shares over several homes."""
    names = [k for k, v in scores[0].items() if isinstance(v, int)]
    counts = {k: sum(s[k] for s in scores) for k in names}
    return counts | _shares(counts)


def false_places(wrong: Sequence[Claim]) -> list[dict[str, Any]]:
    """Claims that lie on no container, one for each place that two views or more claim."""
    places: list[list[Claim]] = []
    for index, d in wrong:
        for place in places:
            if np.linalg.norm(d.position_xyz - place[0][1].position_xyz) < SAME_PLACE_M:
                place.append((index, d))
                break
        else:
            places.append([(index, d)])
    return [
        {**described(*place[0]), "views": sorted({index for index, _ in place})}
        for place in places
        if len({index for index, _ in place}) >= VIEWS
    ]


def _median(values: Iterable[float]) -> float | None:
    listed = list(values)
    return round(statistics.median(listed), 3) if listed else None


def thing_at(d: Detection, things: list[dict[str, Any]]) -> dict[str, Any] | None:
    """The smallest thing whose box holds the detection's centre."""
    x, y, z = d.box.center_xyz
    best, volume = None, np.inf
    for thing in things:
        low, high = np.array(thing["min"]) - BESIDE_M, np.array(thing["max"]) + BESIDE_M
        if np.all((np.array([x, y, z]) >= low) & (np.array([x, y, z]) <= high)):
            size = float(np.prod(high - low))
            if size < volume:
                best, volume = thing, size
    return best
