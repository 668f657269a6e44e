"""The small tables that plugins ship: curves, and what they were counted from."""

from __future__ import annotations

import csv
import inspect
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from afkb_mapping.calibration import ANY, CalibratedDetector
from bench.calibration.fitting import curves_of
from bench.calibration.samples import Sample

FILE = "calibration.csv"
COUNTED = ("examples", "right", "things", "buildings", "source")


def write_tables(
    detectors: Sequence[Any], samples: Sequence[Sample], source: str
) -> dict[Path, float]:
    """Write each detector's table into its plugin's folder; returns how far it moved, by file.

    That is the largest change of a probability among the samples: what a detector is told by lower
    stages depends on their tables, so that fitting again may move it once more.
    """
    moved: dict[Path, float] = {}
    for detector in detectors:
        own = [s for s in samples if s.detector == detector.name]
        if own:
            path = folder_of(detector) / FILE
            moved[path] = max(_write(path, detector.name, own, source), moved.get(path, 0.0))
    return moved


def folder_of(detector: Any) -> Path:
    """The folder of the code of a detector."""
    scorer = detector.scorer if isinstance(detector, CalibratedDetector) else detector
    return Path(inspect.getfile(type(scorer))).parent


def _write(path: Path, detector: str, samples: Sequence[Sample], source: str) -> float:
    curves = curves_of(samples)
    rows = []
    for feature, curve in curves.items():
        own = samples if feature == ANY else [s for s in samples if s.feature == feature]
        rows.append(
            {
                "detector": detector,
                "feature": feature,
                **asdict(curve),
                "examples": len(own),
                "right": sum(s.right for s in own),
                "things": len({(s.building, s.thing) for s in own}),
                "buildings": len({s.building for s in own}),
                "source": source,
            }
        )
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, list(rows[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    return max(abs(s.p - s.by(curves.get(s.feature) or curves[ANY])) for s in samples)
