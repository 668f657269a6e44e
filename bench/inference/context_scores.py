"""How right existence is without and with context, at fixed thresholds and all in all.

A node is a row with `right`, and without and with context `p`, how surely it exists, and `in_map`,
whether the map states it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

THRESHOLDS = (0.5, 0.65, 0.7)
"""The map's own, and what the paper gives predicted things (Algorithm 1)."""
BINS = np.linspace(0.0, 1.0, 6)
"""Edges of the bins of existence: a few dozen nodes fill no more than five."""
SURFACES, THINGS = "surfaces", "things"
WITHOUT, WITH = "without", "with"

Row = Mapping[str, Any]


def by_kind(nodes: Sequence[Row], well: Sequence[Row]) -> dict[str, Any]:
    """Scores of surfaces and of things."""
    return {
        kind: scores(
            [n for n in nodes if n["kind"] == kind], [t for t in well if t["kind"] == kind]
        )
        for kind in (SURFACES, THINGS)
    }


def scores(nodes: Sequence[Row], well: Sequence[Row]) -> dict[str, Any]:
    """Of one kind: how sure all considered are, and at each threshold what is stated."""
    right = np.array([n["right"] for n in nodes], dtype=bool)
    return {
        "considered": len(nodes),
        "right": int(right.sum()),
        "seen_well": len(well),
        "sure": {
            by: _how_sure(np.array([n["p"][by] for n in nodes]), right) for by in (WITHOUT, WITH)
        },
        "at": {str(t): _at(t, nodes, well, right) for t in THRESHOLDS},
    }


def _how_sure(p: Any, right: Any) -> dict[str, float]:
    """Brier score and expected calibration error of existence."""
    if not len(p):
        return {}
    bins = np.clip(np.digitize(p, BINS) - 1, 0, len(BINS) - 2)
    gaps = [abs((p - right)[bins == b].sum()) for b in np.unique(bins)]
    return {
        "brier": round(float(((p - right) ** 2).mean()), 3),
        "calibration_error": round(float(sum(gaps) / len(p)), 3),
    }


def _stated(node: Row, by: str, threshold: float) -> bool:
    return bool(node["in_map"][by] and node["p"][by] >= threshold)


def _at(threshold: float, nodes: Sequence[Row], well: Sequence[Row], right: Any) -> dict[str, Any]:
    stated = {
        by: np.array([_stated(n, by, threshold) for n in nodes], bool) for by in (WITHOUT, WITH)
    }
    rose, fell = stated[WITH] & ~stated[WITHOUT], stated[WITHOUT] & ~stated[WITH]
    told: dict[str, Any] = {
        "rose": int(rose.sum()),
        "rose_rightly": int((rose & right).sum()),
        "fell": int(fell.sum()),
        "fell_rightly": int((fell & ~right).sum()),
    }
    for by, those in stated.items():
        hits = int((those & right).sum())
        told[by] = {
            "stated": int(those.sum()),
            "right": hits,
            "precision": round(hits / those.sum(), 3) if those.any() else None,
            "recall": round(hits / right.sum(), 3) if right.any() else None,
            "found": sum(any(_stated(n, by, threshold) for n in t["nodes"]) for t in well),
        }
    return told
