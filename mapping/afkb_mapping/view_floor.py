"""Free floor in one view: where a robot could go, by what the view alone shows."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from afkb.flow import View
from afkb_mapping.geometry import yaw_of
from afkb_mapping.panorama import panorama_of

Array = NDArray[np.float64]

DETAIL_M = 0.02
"""Sensors are no better than this at a few metres."""
LEAST_DIRECTIONS = 3
"""Fewer directions side by side are a ray, and no area."""


def free_floor(view: View) -> tuple[Array, ...]:
    """Outlines (N, 2) of what is seen to be free around the sensor, m, map frame.

    With a laser: as far as its beams go, or to what depth shows to stand in the way at another
    height. From depth alone: to the nearest thing in the way, or to the last floor that is seen.
    Star-shaped about the sensor; one outline per run of directions that are known.
    """
    panorama = panorama_of(view)
    if view.scan is not None:
        T, hit = view.T_map_laser, view.scan.hit
        center, bearings = T[:2, 3], view.scan.angles + yaw_of(T)
        reach = np.where(hit, view.scan.ranges_m, 0.0).astype(np.float64)
        if panorama is not None:
            ends = center + reach[:, None] * np.column_stack([np.cos(bearings), np.sin(bearings)])
            index, off = panorama.at(ends)
            nearer = panorama.obstacle_m[index] < off
            reach = np.where(nearer, np.minimum(reach, panorama.obstacle_m[index]), reach)
    elif panorama is not None:
        center, bearings, reach = panorama.center_xy, panorama.bearings, panorama.free_m
    else:
        return ()
    return tuple(_outlines(center, bearings, reach))


def area_m2(outline_xy: Array) -> float:
    """Area within an outline (N, 2), m²."""
    x, y = outline_xy.T
    return float(abs(x @ np.roll(y, -1) - y @ np.roll(x, -1)) / 2)


def _outlines(center_xy: Array, bearings: Array, reach_m: Array) -> list[Array]:
    known = np.flatnonzero(reach_m > 0)
    if not len(known):
        return []
    runs = np.split(known, np.flatnonzero(np.diff(known) > 1) + 1)
    found = []
    for run in runs:
        if len(run) >= LEAST_DIRECTIONS:
            r, angle = reach_m[run, None], bearings[run]
            ends = center_xy + r * np.column_stack([np.cos(angle), np.sin(angle)])
            outline = ends if len(run) == len(bearings) else np.vstack([center_xy, ends])
            found.append(_simplified(outline))
    return found


def _simplified(outline_xy: Array) -> Array:
    """The same outline without the points that change it by less than `DETAIL_M`."""
    import cv2

    kept = cv2.approxPolyDP(outline_xy.astype(np.float32).reshape(-1, 1, 2), DETAIL_M, True)
    return np.asarray(kept.reshape(-1, 2), dtype=np.float64)
