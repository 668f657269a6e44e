"""Doorways found in drawn floor plans, against the lines by which people cut them into rooms.

    python -m bench.floor_plans [DIR] [--json]

`DIR` holds pairs `NAME.png`, `NAME_gt_segmentation.png` (Bormann et al., ICRA 2016), 5 cm a pixel,
free floor white; the second is the first with lines across passages. A plan tells no heights, so
all that stands counts as tall. Doorways are sought as in the map of a recording without a laser.
"""

from __future__ import annotations

import argparse
import json
import math
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from afkb.flow import OccupancyGrid
from afkb_mapping.doorways.detour import room_to_room
from afkb_mapping.doorways.judge import beside_wall, through_wall
from afkb_mapping.doorways.merger import LIKELY, WIDTH_M
from afkb_mapping.doorways.narrows import gaps_of_map
from bench.detectors.data import NoData, data_folder

Array = NDArray[np.float64]

RESOLUTION_M = 0.05
TRUTH = "_gt_segmentation.png"
FREE_FROM, LINE_BELOW = 250, 200
"""Grey of free floor, and of lines across it."""
DOOR_M = (WIDTH_M[0], WIDTH_M[2])
"""Lines as long as this are doorways; longer ones cut open spaces, and are neither missed nor
wrong."""
NEAR_M = 0.6
"""People draw a line somewhere in the passage."""


def main(argv: Sequence[str] | None = None) -> int:
    """Table or JSON of every plan, and of all."""
    parser = argparse.ArgumentParser(prog="python -m bench.floor_plans", description=__doc__)
    parser.add_argument("folder", nargs="?", type=Path, default=data_folder() / "floorplans")
    parser.add_argument("--json", action="store_true")
    args = parser.parse_args(argv)
    truths = sorted(args.folder.glob("*" + TRUTH))
    if not truths:
        sys.stderr.write(f"no NAME{TRUTH} in {args.folder}\n")
        return 1
    result = {t.name.removesuffix(TRUTH): judged(t) for t in truths}
    if args.json:
        json.dump(result, sys.stdout, indent=1)
        return 0
    for name, r in result.items():
        sys.stdout.write(f"{name}: {_said(r)}, {r['free_m2']:.0f} m² in {r['seconds']:.1f} s\n")
    keys = ("doors", "found", "claims", "right")
    sys.stdout.write(f"all: {_said({k: sum(r[k] for r in result.values()) for k in keys})}\n")
    return 0


def judged(truth: Path) -> dict[str, Any]:
    """Counts of doors that are drawn and found, and of claims and right ones, of one plan."""
    plan, cut = read_plan(truth.with_name(truth.name.replace(TRUTH, ".png"))), read_plan(truth)
    free = plan >= FREE_FROM
    lines, lengths = _lines(free & (cut < LINE_BELOW))
    start = time.thread_time()
    claims = doorways_in(free)
    seconds = time.thread_time() - start
    near = np.linalg.norm(lines[:, None] - claims[None], axis=2) < NEAR_M
    doors = (lengths >= DOOR_M[0]) & (lengths <= DOOR_M[1])
    return {
        "doors": int(doors.sum()),
        "found": int(near[doors].any(axis=1).sum()),
        "claims": len(claims),
        "right": int(near.any(axis=0).sum()),
        "free_m2": float(free.sum()) * RESOLUTION_M**2,
        "seconds": seconds,
    }


def read_plan(path: Path) -> NDArray[np.uint8]:
    """(rows, cols) grey values of a plan. Raises `NoData` where it is no image."""
    plan = cv2.imread(str(path), cv2.IMREAD_GRAYSCALE)
    if plan is None:
        raise NoData(f"{path}: no image that can be read")
    return np.asarray(plan, dtype=np.uint8)


def doorways_in(free: NDArray[np.bool_]) -> Array:
    """Middles (N, 2), m, of the likely doorways of a plan by its free cells."""
    grid = OccupancyGrid(np.where(free, 0.0, 1.0).astype(np.float32), RESOLUTION_M, (0.0, 0.0))
    found = []
    for jambs, p in gaps_of_map(free, ~free, grid, WIDTH_M):
        p *= beside_wall(jambs, ~free, grid) * through_wall(jambs, ~free, grid)
        if p >= LIKELY and p * room_to_room(jambs, free, grid) >= LIKELY:
            found.append(jambs.mean(axis=0))
    return np.array(found).reshape(-1, 2)


def _lines(drawn: NDArray[np.bool_]) -> tuple[Array, Array]:
    """Middles (N, 2) and lengths (N,) of connected strokes, m."""
    strokes, _ = ndimage.label(drawn, structure=np.ones((3, 3)))
    boxes = [[(s.start, s.stop) for s in box] for box in ndimage.find_objects(strokes)]
    middles = [[(c0 + c1) / 2, (r0 + r1) / 2] for (r0, r1), (c0, c1) in boxes]
    lengths = [math.hypot(r1 - r0, c1 - c0) for (r0, r1), (c0, c1) in boxes]
    return np.reshape(middles, (-1, 2)) * RESOLUTION_M, np.array(lengths) * RESOLUTION_M


def _said(r: dict[str, Any]) -> str:
    return f"found {r['found']} of {r['doors']}, right {r['right']} of {r['claims']}"


if __name__ == "__main__":
    raise SystemExit(main())
