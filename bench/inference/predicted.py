"""Predicted supports and things against what was later seen, and what is truly there.

    python -m bench.inference predicted [--map MAP --home HOME]... [--homes FOLDER] [--json]

A home is a folder with `bag/` and `truth.json`; homes without a `--map` are mapped first. Each map
is built anew from what it remembers, twice:

- as it was seen: what is predicted is what was not in view yet;
- tables hidden: no support from 0.58 m to 1.08 m is ever detected, so that all of them have to be
  predicted from what stands on them and around them.

A prediction is true if the home has such a support within reach of what it followed from; it was
seen if a sight confirmed it. Precision is of all predictions that ever were as probable.
Calibration is over all steps of all their lives, each weighing the same.
"""

from __future__ import annotations

import argparse
from collections import Counter, defaultdict
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from afkb.plugins.host import PluginHost
from bench.inference.blinded import blinded, nothing, tops_of_tables
from bench.inference.home_maps import add_arguments, home_maps
from bench.inference.predicted_truth import Predicted, predictions_of

__all__ = ["add_arguments", "run", "table"]

THRESHOLDS = (0.7, 0.65, 0.5)
EDGES = (0.0, 0.2, 0.4, 0.5, 0.65, 0.7, 0.8, 1.0)
WAYS = {"as it was seen": nothing, "tables hidden": tops_of_tables}


def run(args: argparse.Namespace) -> dict[str, Any]:
    """Scores by what was hidden, and every prediction."""
    host = PluginHost()
    told: dict[str, list[Predicted]] = defaultdict(list)
    for folder, home in home_maps(args, host):
        for way, hides in WAYS.items():
            found = blinded(folder, host, hides)
            truth, kb = home.truth, host.knowledge_base
            told[way] += predictions_of(found, truth, home.name, kb)
    return {way: scores(predictions) for way, predictions in told.items()}


def scores(told: Sequence[Predicted]) -> dict[str, Any]:
    """Precision at each threshold, by order and axiom, and calibration."""
    by_axiom: dict[str, list[Predicted]] = defaultdict(list)
    for prediction in told:
        by_axiom[f"order {prediction.order}: {' and '.join(sorted(prediction.axioms))}"] += [
            prediction
        ]
    steps = [(p, prediction.true) for prediction in told for p in prediction.steps]
    return {
        "predictions": len(told),
        "states": dict(Counter(p.state for p in told)),
        "precision": {
            str(at): precision([p for p in told if max(p.steps) >= at]) for at in THRESHOLDS
        },
        "precision, last word": {
            str(at): precision([p for p in told if p.last >= at]) for at in THRESHOLDS
        },
        "by axiom": {name: precision(ps) for name, ps in sorted(by_axiom.items())},
        "calibration": calibration([p for p, _ in steps], [true for _, true in steps]),
        "calibration, last word": calibration([p.last for p in told], [p.true for p in told]),
        "confirmed, and true": precision([p for p in told if p.seen]),
        "refuted, and true": precision([p for p in told if p.state == "Refuted"]),
    }


def precision(told: Sequence[Predicted]) -> dict[str, int]:
    """How many, how many of them are true, how many were seen to be."""
    return {
        "number": len(told),
        "true": sum(p.true for p in told),
        "seen": sum(p.seen for p in told),
    }


def calibration(told: Sequence[float], true: Sequence[bool]) -> dict[str, Any]:
    """Brier's score, that of their true share for all, expected calibration error, and its bins."""
    if not told:
        return {}
    p, t = np.array(told), np.array(true, float)
    bins = [
        (lo, hi, int(inside.sum()), round(float(p[inside].mean()), 3), round(t[inside].mean(), 3))
        for lo, hi in pairwise(EDGES)
        if (inside := (p >= lo) & ((p < hi) | (hi == EDGES[-1]))).any()
    ]
    error = sum(n * abs(mean - share) for _, _, n, mean, share in bins) / len(p)
    return {
        "steps": len(p),
        "Brier": round(float(((p - t) ** 2).mean()), 4),
        "Brier, always the share": round(float(((t.mean() - t) ** 2).mean()), 4),
        "error": round(float(error), 4),
        "bins": bins,
    }


def table(result: dict[str, Any]) -> Iterator[str]:
    """Lines by what was hidden."""
    for way, found in result.items():
        yield f"{way}: {found['predictions']} predictions, {found['states']}"
        for key in ("precision", "precision, last word"):
            for at, row in found[key].items():
                yield f"  {key} at {at}: {_said(row)}"
        for name, row in found["by axiom"].items():
            yield f"  {name}: {_said(row)}"
        for key in ("confirmed, and true", "refuted, and true"):
            yield f"  {key}: {_said(found[key])}"
        for key in ("calibration", "calibration, last word"):
            told = found[key]
            if told:
                yield (
                    f"  {key}: error {told['error']:.3f}, Brier {told['Brier']:.3f} "
                    f"(always the share: {told['Brier, always the share']:.3f})"
                )
                for lo, hi, n, mean, share in told["bins"]:
                    within = f"{lo:.2f} to {hi:.2f}: {n:4} steps"
                    yield f"    {within}, mean {mean:.2f}, true {share:.2f}"


def _said(row: dict[str, int]) -> str:
    share = f" ({row['true'] / row['number']:.2f})" if row["number"] else ""
    return f"{row['number']} predicted, {row['true']} true{share}, {row['seen']} seen"
