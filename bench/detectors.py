"""Score the depth detectors against a recording whose truth is known.

python -m bench.detectors HOME/bag --truth HOME/truth.json [--json] [--wrong] [--stride N]
"""

from __future__ import annotations

import argparse
import json
import statistics
import sys
import time
from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from afkb.flow import Detection, View

HEIGHT_TOLERANCE_M = 0.03
MARGIN_M = 0.05
SEEN_WELL_TOP_PIXELS = 3000
SEEN_WELL_PIXELS = 600
CLAIMED = 0.5
NOT_A_SUPPORT = ("carpet", "window", "door", "picture", "mirror")
HOLLOW = ("mug", "bowl", "cups", "pitcher")
CLOSED = ("box", "can", "bottle", "cleanser")
LARGE_CONTAINERS = ("basket", "trash_can", "bathtub", "sink", "toilet")


@dataclass
class Run:
    """Every detection of a recording, by view, and what each detector took."""

    views: list[tuple[int, list[Detection]]] = field(default_factory=list)
    milliseconds: dict[str, list[float]] = field(default_factory=lambda: defaultdict(list))

    def of(self, feature: str, at_least: float = CLAIMED) -> Iterator[tuple[int, Detection]]:
        """Claims of a feature, with the view they were made in."""
        for index, detections in self.views:
            for detection in detections:
                if detection.affords(feature, at_least):
                    yield index, detection


def run_detectors(views: Iterable[View], detectors: Sequence[Any]) -> Run:
    run = Run()
    for view in views:
        found: list[Detection] = []
        for detector in sorted(detectors, key=lambda d: d.stage):
            start = time.thread_time()
            new = list(detector.detect(view, tuple(found)))
            run.milliseconds[detector.name].append(1e3 * (time.thread_time() - start))
            found += new
        run.views.append((view.index, found))
    return run


def placed_views(views: Iterable[object], truth: dict[str, Any]) -> Iterator[View]:
    """The views at their true poses, matched by stamp."""
    stamps = np.array([v["stamp"] for v in truth["views"]])
    for view in views:
        if not isinstance(view, View) or view.depth_m is None:
            continue
        nearest = int(np.abs(stamps - view.stamp).argmin())
        if abs(stamps[nearest] - view.stamp) > 0.05:
            continue
        pose = truth["views"][nearest]
        yield replace(view, T_map_base=_planar(pose["x"], pose["y"], pose["yaw"]))


def _planar(x: float, y: float, yaw: float) -> NDArray[np.float64]:
    T = np.eye(4)
    T[:2, :2] = [[np.cos(yaw), -np.sin(yaw)], [np.sin(yaw), np.cos(yaw)]]
    T[:2, 3] = x, y
    return T


def inside(thing: dict[str, Any], xy: NDArray[np.float64]) -> NDArray[np.bool_]:
    low, high = np.array(thing["min"][:2]) - MARGIN_M, np.array(thing["max"][:2]) + MARGIN_M
    result: NDArray[np.bool_] = np.all((xy >= low) & (xy <= high), axis=1)
    return result


def score_supports(run: Run, truth: dict[str, Any]) -> dict[str, Any]:
    things = [t for t in truth["things"] if t["category"] not in NOT_A_SUPPORT]
    claims = [(i, d) for i, d in run.of("SupportAbility") if not d.measures.get("is_floor")]
    rows, errors = [], []
    for thing in things:
        if thing["top_pixels"] < SEEN_WELL_TOP_PIXELS:
            continue
        row, heights = _support_row(thing, claims)
        rows.append(row)
        errors += heights
    wrong = [_described(i, d) for i, d in claims if not _in_some_thing(d, things)]
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


def _in_some_thing(d: Detection, things: list[dict[str, Any]]) -> bool:
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


def _described(index: int, d: Detection) -> dict[str, Any]:
    return {
        "view": index,
        "p": {k: round(v, 2) for k, v in d.affordances.items()},
        "position": [round(float(v), 2) for v in d.position_xyz],
        "size": [round(v, 2) for v in d.box.size_xyz],
        "pixels": d.n_pixels,
        "range": round(d.range_m, 2),
        "measures": {k: round(v, 3) for k, v in d.measures.items()},
    }


def kind_of(thing: dict[str, Any]) -> str | None:
    """`hollow`, `closed`, `large`, or None for what isn't a container."""
    category = thing["category"]
    small = max(np.array(thing["max"]) - np.array(thing["min"])) < 0.4 and category[:3].isdigit()
    if small and any(word in category for word in HOLLOW):
        return "hollow"
    if small and any(category.endswith(word) for word in CLOSED):
        return "closed"
    return "large" if category in LARGE_CONTAINERS else None


def score_containers(run: Run, truth: dict[str, Any]) -> dict[str, Any]:
    """Small things found over the recording, and how many claims lie on a real container."""
    claims = list(run.of("ContainAbility"))
    hits: dict[str, list[Detection]] = defaultdict(list)
    wrong = []
    for index, d in claims:
        thing = _thing_at(d, truth["things"])
        if thing is None or kind_of(thing) is None:
            name = thing["name"] if thing else None
            wrong.append({**_described(index, d), "lies_on": name})
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


def _thing_at(d: Detection, things: list[dict[str, Any]]) -> dict[str, Any] | None:
    """The smallest thing whose box holds the detection's centre."""
    x, y, z = d.box.center_xyz
    best, volume = None, np.inf
    for thing in things:
        low, high = np.array(thing["min"]) - 0.04, np.array(thing["max"]) + 0.04
        if np.all((np.array([x, y, z]) >= low) & (np.array([x, y, z]) <= high)):
            size = float(np.prod(high - low))
            if size < volume:
                best, volume = thing, size
    return best


def score(run: Run, truth: dict[str, Any]) -> dict[str, Any]:
    return {
        "views": len(run.views),
        "supports": score_supports(run, truth),
        "containers": score_containers(run, truth),
        "milliseconds": {
            name: {"median": float(np.median(t)), "p95": float(np.percentile(t, 95))}
            for name, t in run.milliseconds.items()
        },
    }


def table(result: dict[str, Any]) -> Iterator[str]:
    s, c = result["supports"], result["containers"]
    yield (
        f"supports   recall {s['recall']:.2f} of {s['seen_well']}, "
        f"precision {s['precision']:.3f} of {s['claims']}"
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
    yield f"containers precision {c['precision']:.3f} of {c['claims']}"
    for kind in ("hollow", "closed", "large"):
        yield f"  {kind} recall {c[kind]['recall']:.2f}"
        for row in c[kind]["things"]:
            yield (
                f"    {row['name']:28} {row['most_pixels']:6d} px views {row['views']} "
                f"closed {row['as_closed']} top {row['top_error']}"
            )
    for name, ms in result["milliseconds"].items():
        yield f"{name:10} median {ms['median']:.1f} ms, 95 % {ms['p95']:.1f} ms"


def main(argv: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("recording")
    parser.add_argument("--truth", type=Path, required=True)
    parser.add_argument("--stride", type=int, default=1)
    parser.add_argument("--wrong", action="store_true", help="list every false claim")
    parser.add_argument("--json", action="store_true")
    args = parser.parse_args(argv)
    from afkb.plugins.host import PluginHost

    host = PluginHost()
    truth = json.loads(args.truth.read_text())
    source = host.open_source(args.recording)
    views = placed_views(source.views(stride=args.stride), truth)
    detectors = [d for d in host.detectors() if d.name in ("surfaces", "containers")]
    report(score(run_detectors(views, detectors), truth), as_json=args.json, wrong=args.wrong)
    return 0


def report(result: dict[str, Any], as_json: bool, wrong: bool) -> None:
    if as_json:
        json.dump(result, sys.stdout, indent=1)
        return
    lines = list(table(result))
    if wrong:
        for part in ("supports", "containers"):
            lines += [f"wrong {part}: {json.dumps(w)}" for w in result[part]["wrong"]]
    sys.stdout.write("\n".join(lines) + "\n")


if __name__ == "__main__":
    raise SystemExit(main())
