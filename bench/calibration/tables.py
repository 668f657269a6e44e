"""The small tables that plugins ship: curves, and what they were counted from."""

from __future__ import annotations

import csv
import inspect
from collections import defaultdict
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from afkb_mapping.calibration import CalibratedDetector
from bench.calibration.fitting import curves_of
from bench.calibration.samples import Sample

FILE = "calibration.csv"


def write_tables(detectors: Sequence[Any], samples: Sequence[Sample]) -> dict[Path, float]:
    """Write each detector's table into its plugin's folder; returns how far it moved, by file.

    That is the largest change of a probability among the samples: what a detector is told by lower
    stages depends on their tables, so that fitting again may move it once more.
    """
    named: dict[Path, set[str]] = defaultdict(set)
    for detector in detectors:
        named[folder_of(detector) / FILE].add(detector.name)
    moved = {}
    for path, names in named.items():
        own = [s for s in samples if s.detector in names]
        if own:
            moved[path] = _write(path, own)
    return moved


def folder_of(detector: Any) -> Path:
    """The folder of the code of a detector."""
    scorer = detector.scorer if isinstance(detector, CalibratedDetector) else detector
    return Path(inspect.getfile(type(scorer))).parent


def _write(path: Path, samples: Sequence[Sample]) -> float:
    rows, moved = [], 0.0
    for detector in sorted({s.detector for s in samples}):
        of = [s for s in samples if s.detector == detector]
        for feature, curve in curves_of(of).items():
            own = [s for s in of if s.feature == feature]
            moved = max(moved, *(abs(s.p - s.by(curve)) for s in own))
            rows.append({"detector": detector, "feature": feature, **asdict(curve), **_counts(own)})
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, list(rows[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    return moved


def _counts(samples: Sequence[Sample]) -> dict[str, Any]:
    """What a curve rests on."""
    buildings = sorted({s.building for s in samples})
    return {
        "examples": len(samples),
        "right": sum(s.right for s in samples),
        "things": len({(s.building, s.thing) for s in samples}),
        "buildings": "; ".join(buildings),
    }
