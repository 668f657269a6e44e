"""How far the poses of a recording are off, by its odometry and after scan matching.

    python -m bench.trajectory RECORDING --truth truth.json [--option key=value] [--json]
    python -m bench.trajectory RECORDING --relations intel.relations [--option poses=odom] [--json]

With a truth of the form of `homes/*/truth.json` (world frame, the first view's pose is the start):
distance from the true position (m) and heading (degrees) of every view. With relations (Kümmerle et
al. 2009, lines `t1 t2 x y z roll pitch yaw`): error of the relative pose of every pair of views
that a relation joins, in translation (m) and rotation (degrees).
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from afkb.errors import BadFrame
from afkb.flow import View
from afkb.plugins.host import PluginHost
from afkb_mapping.geometry import T_from_xy_yaw, yaw_of
from afkb_mapping.placing.levelling import level
from afkb_mapping.placing.registration import ScanRegistration

SAME_MOMENT_S = 0.005
"""A relation holds for two views if its times are theirs within this."""
SAMPLED_VIEWS = 20


def run(recording: str, options: dict[str, str], stride: int) -> dict:
    """Stamps, poses by odometry and by registration (N, 4, 4) from the first view on, ms a view."""
    source = PluginHost().open_source(recording, options)
    views = [v for v in source.views(stride=stride) if isinstance(v, View)]
    sample = views[:: max(1, len(views) // SAMPLED_VIEWS)]
    registration = ScanRegistration(level(sample, source.gravity_aligned).T_map_source)
    used, registered, matched, milliseconds = [], [], 0, []
    for view in views:
        begun = time.perf_counter()
        try:
            placed = registration.place(view)
        except BadFrame:
            continue
        used.append(view)
        milliseconds.append(1e3 * (time.perf_counter() - begun))
        registered.append(placed.T_map_base)
        matched += placed.matched
    return {
        "stamps": np.array([v.stamp for v in used]),
        "odometry": _from_first([v.T_odom_base for v in used]),
        "registered": _from_first(registered),
        "matched": matched,
        "milliseconds": np.array(milliseconds),
    }


def _from_first(poses: Sequence[np.ndarray]) -> np.ndarray:
    return np.linalg.inv(poses[0]) @ np.array(poses)


def absolute_errors(stamps: np.ndarray, poses: np.ndarray, truth: dict) -> np.ndarray:
    """(N, 2) distance (m) and turn (degrees) of each pose from the true one of that stamp."""
    true = {round(v["stamp"], 3): T_from_xy_yaw(v["x"], v["y"], v["yaw"]) for v in truth["views"]}
    start = np.linalg.inv(true[round(stamps[0], 3)])
    pairs = [
        (start @ true[round(t, 3)], T)
        for t, T in zip(stamps, poses, strict=True)
        if round(t, 3) in true
    ]
    return np.array([_difference(a, b) for a, b in pairs])


def relation_errors(stamps: np.ndarray, poses: np.ndarray, relations: np.ndarray) -> np.ndarray:
    """(N, 2) translation (m) and rotation (degrees) error of each relation between two views.

    Where several of the relations' times fall on one view (logs round their stamps to 10 ms), it
    isn't known which of them is its: these are left out.
    """
    offset = _clock_offset(stamps, np.unique(relations[:, :2]))
    view_at = _views_at(stamps + offset, np.unique(relations[:, :2]))
    errors = []
    for relation in relations:
        if not all(t in view_at for t in relation[:2]):
            continue
        ends = [view_at[t] for t in relation[:2]]
        measured = np.linalg.inv(poses[ends[0]]) @ poses[ends[1]]
        errors.append(_difference(T_from_xy_yaw(*relation[[2, 3, 7]]), measured))
    return np.array(errors)


def _views_at(stamps: np.ndarray, times: np.ndarray) -> dict[float, int]:
    """The view of each time that has one to itself."""
    nearest = np.abs(stamps[None] - times[:, None]).argmin(axis=1)
    same = np.abs(stamps[nearest] - times) <= SAME_MOMENT_S
    claims = np.bincount(nearest[same], minlength=len(stamps))
    return {t: int(k) for t, k in zip(times[same], nearest[same], strict=True) if claims[k] == 1}


def _clock_offset(stamps: np.ndarray, times: np.ndarray) -> float:
    """What to add to the recording's clock so that most views fall on times of relations."""
    differences = (times[:, None] - stamps[None]).ravel()
    bins = np.round(differences / SAME_MOMENT_S).astype(np.int64)
    found, counts = np.unique(bins, return_counts=True)
    near = np.abs(bins - found[np.argmax(counts)]) <= 2
    return float(np.median(differences[near]))


def _difference(T_a: np.ndarray, T_b: np.ndarray) -> tuple[float, float]:
    T = np.linalg.inv(T_a) @ T_b
    return float(np.hypot(T[0, 3], T[1, 3])), abs(float(np.degrees(yaw_of(T))))


def _summary(errors: np.ndarray) -> dict:
    return {
        name: {
            "mean": round(float(column.mean()), 4),
            "std": round(float(column.std()), 4),
            "median": round(float(np.median(column)), 4),
            "greatest": round(float(column.max()), 4),
        }
        for name, column in zip(("metres", "degrees"), errors.T, strict=True)
    }


def evaluate(arguments: argparse.Namespace) -> dict:
    options = dict(o.split("=", 1) for o in arguments.option)
    found = run(arguments.recording, options, arguments.stride)
    if arguments.truth:
        reference = json.loads(arguments.truth.read_text())
        errors = absolute_errors
    else:
        reference = np.loadtxt(arguments.relations, ndmin=2)
        errors = relation_errors
    compared = {
        key: errors(found["stamps"], found[key], reference) for key in ("odometry", "registered")
    }
    return {
        "views": len(found["stamps"]),
        "matched": found["matched"],
        "compared": len(compared["registered"]),
        **{key: _summary(value) for key, value in compared.items()},
        "ms_per_view": {
            "median": round(float(np.median(found["milliseconds"])), 1),
            "greatest": round(float(found["milliseconds"].max()), 1),
        },
    }


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("recording")
    reference = parser.add_mutually_exclusive_group(required=True)
    reference.add_argument("--truth", type=Path)
    reference.add_argument("--relations", type=Path)
    parser.add_argument("--option", action="append", default=[], metavar="KEY=VALUE")
    parser.add_argument("--stride", type=int, default=1)
    parser.add_argument("--json", action="store_true")
    arguments = parser.parse_args()
    result = evaluate(arguments)
    if arguments.json:
        json.dump(result, sys.stdout, indent=1)
        return 0
    for key, value in result.items():
        sys.stdout.write(f"{key}: {value}\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
