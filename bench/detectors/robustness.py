"""How far detection holds under hardship: curves on recordings, counts on rendered views.

Recall is of what the undamaged view shows rightly: supports of `LEAST_PIXELS`, containers. It tells
what a hardship costs, not how much is seen at all. Precision is of what is said under hardship.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from scipy.spatial import cKDTree

from afkb.flow import Detection, View
from bench.detectors.containers import kind_of, thing_at
from bench.detectors.curves import curves
from bench.detectors.data import Asked, Home
from bench.detectors.hardships import hardships
from bench.detectors.seen import CLAIMED, run_detectors
from bench.detectors.staged import SIZES, Stage, laid_table, nothing_to_find
from bench.detectors.surfaces import HEIGHT_TOLERANCE_M, NOT_A_SUPPORT, in_some_thing

NEEDS = ("homes",)
VIEWS = 12
"""Views of each home, evenly over it."""
LEAST_PIXELS = 1000
NEAR_M, SHARED = 0.05, 0.3
"""A support is found again where this share of it lies this near to one at its height."""
SAME_PLACE_M = 0.1
SEED = 11


def run(asked: Asked) -> dict[str, Any]:
    """`curves`: axis to points with recall and precision; `staged`: what is said of each stage."""
    detectors = asked.host.detectors(asked.detectors)
    views = [(v, h.truth["things"]) for h in asked.homes for v in _some(h)]
    result = {
        "views": len(views),
        "curves": _curves(views, detectors),
        "nothing": {s.name: _invented(s, detectors) for s in nothing_to_find()},
        "table": _table_found(laid_table(), detectors),
    }
    if asked.pictures:
        asked.pictures.mkdir(parents=True, exist_ok=True)
        (asked.pictures / "robustness.svg").write_text(curves(result["curves"]))
    return result


def _some(home: Home) -> list[View]:
    """Views that show something: those that see nothing undamaged tell nothing of damage."""
    views = [v for v in home.views() if v.depth_m is not None]
    return views[:: max(1, len(views) // VIEWS)]


def _curves(views: Sequence[tuple[View, list[dict[str, Any]]]], detectors: Any) -> dict[str, Any]:
    found: dict[str, list[dict[str, Any]]] = defaultdict(list)
    whole = [_said(view, detectors) for view, _ in views]
    for hardship in hardships():
        rng = np.random.default_rng(SEED)
        counts: dict[str, int] = defaultdict(int)
        for (view, things), before in zip(views, whole, strict=True):
            after = _said(hardship.befall(view, rng), detectors)
            _count(counts, before, after, things)
        found[hardship.axis].append(
            {"value": hardship.value, "label": hardship.label, **_shares(counts)}
        )
    return dict(found)


def _said(view: View, detectors: Any) -> list[Detection]:
    return run_detectors([view], detectors).views[0][1]


def _count(
    counts: dict[str, int],
    before: Sequence[Detection],
    after: Sequence[Detection],
    things: list[dict[str, Any]],
) -> None:
    flat = [t for t in things if t["category"] not in NOT_A_SUPPORT]
    now = _supports(after)
    for d in _supports(before):
        if d.n_pixels >= LEAST_PIXELS and in_some_thing(d, flat):
            counts["supports"] += 1
            counts["supports_kept"] += any(_same_support(d, other) for other in now)
    counts["supports_said"] += len(now)
    counts["supports_right"] += sum(in_some_thing(d, flat) for d in now)
    held = [d for d in after if d.affords("ContainAbility", CLAIMED)]
    for d in before:
        if d.affords("ContainAbility", CLAIMED) and _contains(d, things):
            counts["containers"] += 1
            counts["containers_kept"] += any(_apart(d, other) <= SAME_PLACE_M for other in held)
    counts["containers_said"] += len(held)
    counts["containers_right"] += sum(_contains(d, things) for d in held)


def _supports(said: Sequence[Detection]) -> list[Detection]:
    return [
        d
        for d in said
        if d.affords("SupportAbility", CLAIMED)
        and "area" in d.measures
        and not d.measures.get("is_floor")
    ]


def _same_support(d: Detection, other: Detection) -> bool:
    if abs(d.measures["height"] - other.measures["height"]) > HEIGHT_TOLERANCE_M:
        return False
    distances, _ = cKDTree(other.footprint_xy).query(d.footprint_xy)
    return bool((distances <= NEAR_M).mean() >= SHARED)


def _contains(d: Detection, things: list[dict[str, Any]]) -> bool:
    thing = thing_at(d, things)
    return thing is not None and kind_of(thing) is not None


def _apart(d: Detection, other: Detection) -> float:
    return float(np.linalg.norm(np.subtract(d.box.center_xyz, other.box.center_xyz)))


def _shares(n: dict[str, int]) -> dict[str, float | None]:
    """Recall and precision; None where nothing was there, or nothing was said."""
    return {
        f"{what}_{name}": n[f"{what}_{part}"] / n[whole] if n[whole] else None
        for what in ("supports", "containers")
        for name, part, whole in (
            ("recall", "kept", what),
            ("precision", "right", f"{what}_said"),
        )
    } | {what: n[what] for what in ("supports", "containers")}


def _invented(stage: Stage, detectors: Any) -> dict[str, int]:
    """Supports, bodies and containers that are said where nothing is, by size of the image."""
    return {
        size: sum(
            max(d.affordances.values()) >= CLAIMED
            for d in _said(stage.view(size, np.random.default_rng(SEED)), detectors)
            if "BlockAbility" not in d.affordances and not d.measures.get("is_floor")
        )
        for size in SIZES
    }


def _table_found(stage: Stage, detectors: Any) -> dict[str, dict[str, Any]]:
    """What of the laid table is said, by image size and noise; `invented`: in no thing's box."""
    things = list(stage.things)
    found = {}
    for size in SIZES:
        for noise in (1.0, 3.0):
            said = _said(stage.view(size, np.random.default_rng(SEED), noise), detectors)
            tops = {
                t["name"]: any(
                    abs(d.measures["height"] - t["max"][2]) <= HEIGHT_TOLERANCE_M
                    and in_some_thing(d, [t])
                    for d in _supports(said)
                )
                for t in things
                if t["name"] in ("table", "stool")
            }
            held = [thing_at(d, things) for d in said if d.affords("ContainAbility", CLAIMED)]
            names = sorted({t["name"] for t in held if t is not None and kind_of(t)})
            invented = sum(not in_some_thing(d, things) for d in _supports(said))
            found[f"{size}, noise x{noise:g}"] = {
                **tops, "containers": names, "invented": invented,
            }  # fmt: skip
    return found


def table(result: dict[str, Any]) -> Iterator[str]:
    yield f"{result['views']} recorded views; recall of what the undamaged view shows, precision"
    for points in result["curves"].values():
        for p in points:
            shares = (
                f"{what} {_share(p[f'{what}_recall'])} {_share(p[f'{what}_precision'])}"
                for what in ("supports", "containers")
            )
            yield f"  {p['label']:18} {'  '.join(shares)}"
    yield "rendered, nothing there: claims at " + ", ".join(SIZES)
    for name, sizes in result["nothing"].items():
        yield f"  {name:18} " + " ".join(f"{n:3d}" for n in sizes.values())
    yield "rendered, a laid table and a stool"
    for name, found in result["table"].items():
        yield f"  {name:20} " + ", ".join(f"{k} {v}" for k, v in found.items())


def _share(value: float | None) -> str:
    return "   -" if value is None else f"{value:.2f}"
