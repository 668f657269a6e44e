"""A real kitchen, held against a list that a person made by looking (`bench/labels`)."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from typing import Any

from bench.detectors.data import Asked
from bench.detectors.kitchen import Kitchen, frame_number, label_of
from bench.detectors.pictures import draw_views
from bench.detectors.seen import Run, described

NEEDS = ("redkitchen",)
SEEN_AGAIN = 2
"""A thing is found if this many views claim it: a map keeps nothing of a single faint look."""


def run(asked: Asked) -> dict[str, Any]:
    """Each entry of the list with the views that claim it, and claims on no entry."""
    kitchen = asked.kitchen
    result = score(kitchen, kitchen.seen)
    if asked.pictures:
        draw_views("redkitchen", kitchen.views(), kitchen.seen, asked.pictures)
    return result


def score(kitchen: Kitchen, seen: Run) -> dict[str, Any]:
    """Claims by entry; those on no entry of their feature are told for a person to judge."""
    features = sorted({entry.feature for entry in kitchen.labels})
    claims: Counter[str] = Counter()
    unlisted = []
    for feature in features:
        for index, d in seen.of(feature):
            entry = label_of(d, feature, frame_number(index), kitchen.labels)
            if entry is not None:
                claims[entry.name] += 1
            elif not d.measures.get("is_floor"):
                unlisted.append({"feature": feature, **described(index, d)})
    entries = [
        {
            "name": entry.name,
            "feature": entry.feature,
            "expect": entry.expect,
            "views": claims[entry.name],
            "in_view": sum(entry.in_view(frame_number(i)) for i, _ in seen.views),
            "right": _right(entry.expect, claims[entry.name]),
        }
        for entry in kitchen.labels
    ]
    return {"views": len(seen.views), "entries": entries, "unlisted": unlisted}


def _right(expect: str, views: int) -> bool:
    return expect == "either" or (views >= SEEN_AGAIN if expect == "found" else views == 0)


def table(result: dict[str, Any]) -> Iterator[str]:
    right = sum(e["right"] for e in result["entries"])
    yield f"{right} of {len(result['entries'])} entries right, in {result['views']} views"
    for e in result["entries"]:
        yield (
            f"  {'' if e['right'] else 'WRONG':5} {e['expect']:6} {e['name']:24} "
            f"{e['feature']:24} claimed in {e['views']:2d} of {e['in_view']:2d} views"
        )
    told = Counter(u["feature"] for u in result["unlisted"])
    yield "  on no entry of the list: " + (", ".join(f"{f} {n}" for f, n in told.items()) or "none")
