"""A scan of a later visit matched to the map of an earlier one: all alike, or by what moves.

The same search, over the same cells and beams, twice. As in a metric map every cell and beam counts
one. As in ours a cell within a dynamic thing of the map counts by its matching weight, and so does
a beam that ends in what the view shows to be dynamic (paper §II.D.i).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from afkb.flow import Detection, OccupancyGrid, View
from afkb.inference import Network
from afkb_mapping.frame_report import described
from afkb_mapping.geometry import T_from_xy_yaw, transform_xy
from afkb_mapping.panorama import panorama_of
from afkb_mapping.routes.route_map import Thing

Array = NDArray[np.float64]

SIGMA_M = 0.1
"""Of the likelihood field (Thrun et al., Probabilistic Robotics, 6.4): two cells."""
REACH_M = 0.6
"""Every cell this near is tried."""
REACH_RAD, STEP_RAD = math.radians(15), math.radians(1.5)
MOST_BEAMS = 240
TRUSTED_M = 5.0
"""Depth further away is wrong by more than a cell."""
BESIDE_M = 0.1
"""What is so near to a thing's outline is the thing."""


@dataclass(frozen=True, slots=True, eq=False)
class Field:
    """How well a beam's end fits at each cell, 0 to 1; `origin_xy` of cell (0, 0), m."""

    fit: NDArray[np.float32]
    resolution_m: float
    origin_xy: Array


def field_of(grid: OccupancyGrid, occupied: NDArray[np.bool_], weights: Array) -> Field:
    """The field of occupied cells (rows, cols), each as high as it weighs."""
    fit = np.zeros(occupied.shape, dtype=np.float32)
    for weight in np.unique(weights[occupied].round(1)):
        these = occupied & (weights.round(1) == weight)
        distance = ndimage.distance_transform_edt(~these) * grid.resolution_m
        fit = np.maximum(fit, weight * np.exp(-((distance / SIGMA_M) ** 2) / 2)).astype(np.float32)
    return Field(fit, grid.resolution_m, np.asarray(grid.origin_xy))


def cell_weights(grid: OccupancyGrid, things: Sequence[Thing], dynamic: set[str]) -> Array:
    """(rows, cols): matching weight of the dynamic thing that a cell is in, else 1."""
    import cv2

    weights = np.ones(grid.probability.shape)
    n = math.ceil(BESIDE_M / grid.resolution_m)
    for thing in (t for t in things if t.id in dynamic):
        mask = np.zeros(weights.shape, np.uint8)
        corners = (thing.polygon_xy - grid.origin_xy) / grid.resolution_m - 0.5
        cv2.fillPoly(mask, [np.round(corners).astype(np.int32)], 1)
        mask = cv2.dilate(mask, np.ones((2 * n + 1, 2 * n + 1), np.uint8)).astype(np.uint8)
        weights[mask > 0] = np.minimum(weights[mask > 0], thing.matching_weight)
    return weights


def beam_weights(ends_xy: Array, detections: Sequence[Detection], network: Network) -> Array:
    """(N,): matching weight of the dynamic thing of this view that a beam ends in, else 1."""
    weights = np.ones(len(ends_xy))
    for detection in detections:
        if detection.segment_xy is not None or not len(detection.footprint_xy):
            continue
        told = described(detection, network)
        if told.get("movability") != "Dynamic":
            continue
        low = detection.footprint_xy.min(axis=0) - BESIDE_M
        high = detection.footprint_xy.max(axis=0) + BESIDE_M
        inside = ((ends_xy >= low) & (ends_xy <= high)).all(axis=1)
        weights[inside] = np.minimum(weights[inside], float(str(told["matching_weight"])))
    return weights


def ends_of(view: View, sense: str) -> Array:
    """(N, 2) m: what a placed view meets by `laser`, or nearest in each direction of `depth`."""
    if sense == "laser":
        assert view.scan is not None
        return transform_xy(view.T_map_laser, view.scan.points_xy)
    panorama = panorama_of(view)
    if panorama is None:
        return np.zeros((0, 2))
    ranges = panorama.obstacle_m
    return panorama.ends_xy(ranges)[ranges < TRUSTED_M]


def best_pose(
    view: View, ends_xy: Array, field: Field, weights: Array
) -> tuple[float, float, float]:
    """How far the best pose near a view's true one is off: x, y (m, map frame) and yaw (rad).

    `ends_xy` (N, 2): what it meets, m, map frame; `weights` (N,) of these.
    """
    assert view.T_map_base is not None
    T = view.T_map_base
    every = max(1, len(weights) // MOST_BEAMS)
    ends = ends_xy[::every] - T[:2, 3]
    w = (weights[::every] / max(weights[::every].sum(), 1e-9)).astype(np.float32)
    reach = round(REACH_M / field.resolution_m)
    fit = np.pad(field.fit, reach)
    best, found = -1.0, (0.0, 0.0, 0.0)
    for turn in np.arange(-REACH_RAD, REACH_RAD + STEP_RAD / 2, STEP_RAD):
        turned = ends @ T_from_xy_yaw(0.0, 0.0, float(turn))[:2, :2].T + T[:2, 3]
        scores = _scores(turned, w, field, fit, reach)
        row, col = np.unravel_index(int(scores.argmax()), scores.shape)
        if scores[row, col] > best:
            best = float(scores[row, col])
            found = (
                (int(col) - reach) * field.resolution_m,
                (int(row) - reach) * field.resolution_m,
                float(turn),
            )
    return found


def _scores(
    ends_xy: Array, weights: Array, field: Field, padded: NDArray[np.float32], reach: int
) -> Array:
    """(2 reach + 1, 2 reach + 1) how well points (N, 2) fit, moved by so many rows and columns."""
    cells = np.floor((ends_xy - field.origin_xy) / field.resolution_m).astype(np.int64)
    inside = ((cells >= 0) & (cells < field.fit.shape[::-1])).all(axis=1)
    windows = np.lib.stride_tricks.sliding_window_view(padded, (2 * reach + 1, 2 * reach + 1))
    cols, rows = cells[inside].T
    scores: Array = np.tensordot(weights[inside], windows[rows, cols], axes=1)
    return scores
