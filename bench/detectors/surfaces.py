"""Supports: found, at their height, and nowhere else."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from afkb.flow import Detection
from bench.detectors.data import Asked, Home
from bench.detectors.nodes import nodes_per_surface, support_nodes
from bench.detectors.seen import MARGIN_M, Run, described, inside

NEEDS = ("homes",)
HEIGHT_TOLERANCE_M = 0.03
SEEN_WELL_TOP_PIXELS = 3000
COVERED = 0.8
NOT_A_SUPPORT = ("carpet", "window", "door", "picture", "mirror")


def run(asked: Asked) -> dict[str, Any]:
    """The score of each home by its name."""
    return {h.name: {**score(h.seen, h.truth), **_nodes(h)} for h in asked.homes}


def _nodes(home: Home) -> dict[str, Any]:
    tops = tops_of(home.truth)
    return {"nodes_per_surface": nodes_per_surface(support_nodes(home), tops, HEIGHT_TOLERANCE_M)}


def tops_of(truth: dict[str, Any]) -> list[dict[str, Any]]:
    """Things whose upward surface was seen well, and is free.

    What another thing lies on, such as a cabinet under its counter, shows no top of its own; what
    the truth tells as one then is a shelf inside it, or its front.
    """
    things = truth["things"]
    return [
        t
        for t in things
        if t["category"] not in NOT_A_SUPPORT
        and t["top_pixels"] >= SEEN_WELL_TOP_PIXELS
        and not any(_covers(other, t) for other in things if other is not t)
    ]


def _covers(other: dict[str, Any], thing: dict[str, Any]) -> bool:
    """Whether another thing lies on most of a thing."""
    low, high = np.array(thing["min"][:2]), np.array(thing["max"][:2])
    shared = np.minimum(high, other["max"][:2]) - np.maximum(low, other["min"][:2])
    on_it = abs(other["min"][2] - thing["max"][2]) < MARGIN_M
    return bool(on_it and np.prod(np.maximum(shared, 0)) > COVERED * np.prod(high - low))


def table(result: dict[str, Any]) -> Iterator[str]:
    for name, s in result.items():
        yield (
            f"{name}: recall {s['recall']:.2f} of {s['seen_well']}, "
            f"precision {s['precision']:.3f} of {s['claims']}, "
            f"{s['nodes_per_surface']:.2f} nodes per real surface"
        )
        if s["height_error_median_m"] is not None:
            yield (
                f"  height error median {1e3 * s['height_error_median_m']:.1f} mm, "
                f"90 % {1e3 * s['height_error_p90_m']:.1f} mm"
            )
        for row in s["things"]:
            off = "-" if row["centre_off_m"] is None else f"{row['centre_off_m']:.2f}"
            yield (
                f"  {row['name']:28} {row['height']:.2f} views {row['views']:3d} "
                f"covered {row['coverage']:.2f} off {off}"
            )


def score(run: Run, truth: dict[str, Any]) -> dict[str, Any]:
    things = [t for t in truth["things"] if t["category"] not in NOT_A_SUPPORT]
    tops = tops_of(truth)
    claims = [(i, d) for i, d in run.of("SupportAbility") if not d.measures.get("is_floor")]
    rows, errors = [], []
    for thing in tops:
        row, heights = _support_row(thing, claims)
        rows.append(row)
        errors += heights
    wrong = [described(i, d) for i, d in claims if not in_some_thing(d, things)]
    found = [r for r in rows if r["found"]]
    return {
        "seen_well": len(rows),
        "recall": len(found) / max(len(rows), 1),
        "claims": len(claims),
        "precision": 1 - len(wrong) / max(len(claims), 1),
        "height_error_median_m": float(np.median(errors)) if errors else None,
        "height_error_p90_m": float(np.percentile(errors, 90)) if errors else None,
        "things": rows,
        "wrong": wrong,
    }


def _support_row(
    thing: dict[str, Any], claims: list[tuple[int, Detection]]
) -> tuple[dict[str, Any], list[float]]:
    """Whether a thing's top was found: union of footprints at its height, over the views."""
    points, heights, count = [], [], 0
    for _, d in claims:
        error = abs(d.measures["height"] - thing["top_height"])
        within = inside(thing, d.footprint_xy)
        if error <= HEIGHT_TOLERANCE_M and within.mean() > 0.3:
            points.append(d.footprint_xy[within])
            count += 1
            if d.n_pixels > 1500 and within.mean() > 0.9:
                heights.append(error)
    cells = np.unique(np.floor(np.vstack(points) / 0.02), axis=0) if points else np.empty((0, 2))
    area = float(np.prod(np.array(thing["max"][:2]) - np.array(thing["min"][:2])))
    off = None
    if len(cells):
        middle = (np.percentile(cells, 1, axis=0) + np.percentile(cells, 99, axis=0) + 1) / 2 * 0.02
        truth_xy = (np.array(thing["min"][:2]) + np.array(thing["max"][:2])) / 2
        off = float(np.hypot(*(middle - truth_xy)))
    row = {
        "name": thing["name"],
        "height": thing["top_height"],
        "found": len(cells) > 0,
        "views": count,
        "coverage": len(cells) * 4e-4 / area,
        "centre_off_m": off,
    }
    return row, heights


def in_some_thing(d: Detection, things: list[dict[str, Any]]) -> bool:
    height = d.measures["height"]
    for thing in things:
        if not thing["min"][2] - MARGIN_M <= height <= thing["max"][2] + HEIGHT_TOLERANCE_M:
            continue
        if inside(thing, d.footprint_xy).mean() > 0.6:
            return True
    near = np.zeros(len(d.footprint_xy), bool)
    for thing in things:
        if thing["min"][2] - MARGIN_M <= height <= thing["max"][2] + HEIGHT_TOLERANCE_M:
            near |= inside(thing, d.footprint_xy)
    return bool(near.mean() > 0.8)
