"""Containers: small hollow and closed things, and large ones such as tubs and sinks."""

from __future__ import annotations

import statistics
from collections import defaultdict
from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np

from afkb.flow import Detection
from bench.detectors.data import Asked
from bench.detectors.seen import Run, described

NEEDS = ("homes",)
SEEN_WELL_PIXELS = 600
HOLLOW = ("mug", "bowl", "cups", "pitcher")
CLOSED = ("box", "can", "bottle", "cleanser")
LARGE_CONTAINERS = ("basket", "trash_can", "bathtub", "sink", "toilet")
BESIDE_M = 0.04


def run(asked: Asked) -> dict[str, Any]:
    """The score of each home by its name."""
    return {h.name: score(h.seen, h.truth) for h in asked.homes}


def table(result: dict[str, Any]) -> Iterator[str]:
    for name, c in result.items():
        yield f"{name}: precision {c['precision']:.3f} of {c['claims']}"
        for kind in ("hollow", "closed", "large"):
            yield f"  {kind} recall {c[kind]['recall']:.2f}"
            for row in c[kind]["things"]:
                yield (
                    f"    {row['name']:28} {row['most_pixels']:6d} px views {row['views']} "
                    f"closed {row['as_closed']} top {row['top_error']}"
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


def score(run: Run, truth: dict[str, Any]) -> dict[str, Any]:
    """Small things found over the recording, and how many claims lie on a real container."""
    claims = list(run.of("ContainAbility"))
    hits: dict[str, list[Detection]] = defaultdict(list)
    wrong = []
    for index, d in claims:
        thing = thing_at(d, truth["things"])
        if thing is None or kind_of(thing) is None:
            name = thing["name"] if thing else None
            wrong.append({**described(index, d), "lies_on": name})
        else:
            hits[thing["name"]].append(d)
    out: dict[str, Any] = {"claims": len(claims), "precision": 1 - len(wrong) / max(len(claims), 1)}
    for kind in ("hollow", "closed", "large"):
        rows = [
            {
                "name": t["name"],
                "most_pixels": t["most_pixels"],
                "views": len(hits[t["name"]]),
                "as_closed": sum(d.affords("IntrinsicContainAbility") for d in hits[t["name"]]),
                "top_error": _median(d.box.top - t["max"][2] for d in hits[t["name"]]),
            }
            for t in truth["things"]
            if kind_of(t) == kind and t["most_pixels"] >= SEEN_WELL_PIXELS
        ]
        found = [r for r in rows if r["views"] > 0]
        out[kind] = {"recall": len(found) / max(len(rows), 1), "things": rows}
    out["wrong"] = wrong
    return out


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
