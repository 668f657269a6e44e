"""How well calibrated detections are: by detector and feature, by distance, and all in one.

Where classes are pooled, skill and AUC are still over each class's own base rate and pairs: that
supports are oftener right than closed packages is no merit of a probability.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict
from itertools import pairwise
from typing import Any

import numpy as np

from bench.calibration.held_out import held_out
from bench.calibration.measures import bootstrapped, reliability, summary
from bench.calibration.samples import Sample

BANDS_M = (0.0, 1.5, 3.0, np.inf)
LEAST = 30
"""Fewer samples than this tell nothing of their own; they count in the pooled lines."""
SEED = 4


def report(samples: Sequence[Sample]) -> dict[str, Any]:
    """Three ways to take probabilities, each by group.

    `shipped`: as detections state them. `scored`: before any table. `held_out`: by curves that were
    fitted on the other buildings; this one tells how well it holds in homes that nobody has seen.
    """
    scored = [Sample(**{**asdict(s), "p": s.score}) for s in samples]
    return {
        "shipped": _by_group(samples),
        "scored": _by_group(scored),
        "held_out": _by_group(held_out(samples)),
    }


def _by_group(samples: Sequence[Sample]) -> dict[str, Any]:
    groups: dict[str, Callable[[Sample], bool]] = {"all": lambda s: True}
    for low, high in pairwise(BANDS_M):
        groups[f"{low:g} to {high:g} m"] = lambda s, low=low, high=high: low <= s.range_m < high
    for name in sorted({s.building for s in samples}):
        groups[name] = lambda s, name=name: s.building == name
    for name in sorted({s.detector for s in samples}):
        groups[f"detector {name}"] = lambda s, name=name: s.detector == name
    for pair in sorted({(s.detector, s.feature) for s in samples}):
        groups[" ".join(pair)] = lambda s, pair=pair: (s.detector, s.feature) == pair
    found = {name: [s for s in samples if among(s)] for name, among in groups.items()}
    return {name: _measured(own) for name, own in found.items() if len(own) >= LEAST}


def _measured(samples: Sequence[Sample]) -> dict[str, Any]:
    p = np.array([s.p for s in samples])
    right = np.array([s.right for s in samples], float)
    classes = np.array([f"{s.detector} {s.feature}" for s in samples])
    scenes = np.array([s.scene for s in samples])
    rng = np.random.default_rng(SEED)
    return {
        **summary(p, right, classes),
        "interval": bootstrapped(p, right, classes, scenes, rng),
        "scenes": len(set(scenes)),
        "bins": [asdict(b) for b in reliability(p, right)],
    }


def table(result: dict[str, Any]) -> Iterator[str]:
    """One line a group; in brackets the 90 % interval over drawn scenes."""
    for way, groups in result.items():
        yield f"{way}: ECE, Brier skill, AUC (90 % over scenes), samples, share right"
        for name, m in groups.items():
            parts = [_with_interval(m, key) for key in ("ece", "brier_skill", "auc")]
            yield f"  {name:40} {' '.join(parts)} {m['samples']:5d} {m['right']:.2f}"


def _with_interval(m: dict[str, Any], key: str) -> str:
    value, ends = m[key], m["interval"].get(key)
    if value is None or ends is None:
        return f"{'-':21}"
    return f"{value:6.3f} ({ends[0]:.3f},{ends[1]:.3f})".ljust(21)
