"""Finds the floor and up, so that a map is level whatever frame a recording's poses came in."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from afkb.flow import View
from afkb_mapping.geometry import back_project, transform

SAMPLED_VIEWS = 40
SAMPLED_VIEWS_UPRIGHT = 6
"""Views to look for the floor in; few suffice where up is known."""
PIXEL_STEP = 6
"""Normals come from points this many pixels apart: far enough for a Kinect's depth steps."""
UPRIGHT_LIMIT = np.deg2rad(50)
"""A camera on a robot or in a hand is upright within this angle; up is searched near its own up."""
SAME_DIRECTION = np.deg2rad(8)
HEIGHT_BIN_M = 0.02
FLOOR_SHARE = 0.05
"""The floor is the lowest level with this share of the largest level's area."""
SMALLEST_FLOOR_M2 = 0.15
MAX_RANGE_M = 5.0
BASE_TO_FLOOR_M = 0.3
"""A robot's base frame lies this close to the floor (REP-120 base_footprint or base_link)."""


@dataclass(frozen=True, slots=True, eq=False)
class Level:
    """`T_map_source` (4, 4) and, where something had to be assumed, a note that says so."""

    T_map_source: NDArray[np.float64]
    note: str | None = None


@dataclass(frozen=True, slots=True, eq=False)
class _Patches:
    """Oriented surface samples in the source frame: points (N, 3), normals (N, 3), areas (N,)."""

    points: NDArray[np.float64]
    normals: NDArray[np.float64]
    areas: NDArray[np.float64]


def level(views: Sequence[View], gravity_aligned: bool) -> Level:
    """Map frame for a recording: z up from the floor, origin under the first view, x ahead.

    `views` is a sample of the recording, its first view first. Recordings whose poses are not
    gravity-aligned get their up from the direction that most upward-facing surface area shares;
    the floor is the lowest level of it.
    """
    first = views[0]
    patches = _patches([v for v in views if v.depth_m is not None])
    camera_up = _mean_camera_up(views)
    up, note = np.array([0.0, 0.0, 1.0]), None
    if not gravity_aligned:
        found = _dominant_up(patches, camera_up)
        if found is None:
            note = "no level surface seen: up is taken from the cameras"
        up = camera_up if found is None else found
    base_height = float(np.median([up @ v.T_odom_base[:3, 3] for v in views]))
    floor = _floor_height(patches, up)
    if first.has_base and (floor is None or abs(floor - base_height) > BASE_TO_FLOOR_M):
        if floor is not None:
            note = "no floor seen at the robot's base: the base stands at z = 0"
        floor = base_height
    if floor is None:
        floor, note = base_height - 1.2, "no floor seen: the camera is taken to be 1.2 m above it"
    return Level(_map_frame(first.T_odom_base, up, floor), note)


def _mean_camera_up(views: Sequence[View]) -> NDArray[np.float64]:
    ups = [
        -(v.T_odom_base @ v.T_base_camera)[:3, 1] for v in views if v.T_base_camera is not None
    ] or [v.T_odom_base[:3, 2] for v in views]
    mean: NDArray[np.float64] = np.mean(ups, axis=0)
    return mean / np.linalg.norm(mean)


def _patches(views: Sequence[View]) -> _Patches:
    parts = [_patches_of(v) for v in views]
    if not parts:
        return _Patches(np.zeros((0, 3)), np.zeros((0, 3)), np.zeros(0))
    return _Patches(
        np.concatenate([p.points for p in parts]),
        np.concatenate([p.normals for p in parts]),
        np.concatenate([p.areas for p in parts]),
    )


def _patches_of(view: View) -> _Patches:
    assert view.depth_m is not None and view.camera is not None and view.T_base_camera is not None
    near = np.where(view.depth_m < MAX_RANGE_M, view.depth_m, 0).astype(np.float32)
    grid = back_project(near, view.camera, PIXEL_STEP).astype(np.float64)
    center = grid[1:-1, 1:-1]
    across = grid[1:-1, 2:] - grid[1:-1, :-2]
    down = grid[2:, 1:-1] - grid[:-2, 1:-1]
    normal = np.cross(down, across)
    length = np.linalg.norm(normal, axis=-1)
    smooth = np.linalg.norm(grid[1:-1, 2:] + grid[1:-1, :-2] - 2 * center, axis=-1)
    smooth += np.linalg.norm(grid[2:, 1:-1] + grid[:-2, 1:-1] - 2 * center, axis=-1)
    with np.errstate(invalid="ignore"):
        good = (length > 0) & (smooth < 0.03 + 0.01 * center[..., 2] ** 2)
    T = view.T_odom_base @ view.T_base_camera
    unit = normal[good] / length[good][:, None]
    unit *= -np.sign(np.einsum("ij,ij->i", unit, center[good]))[:, None]
    return _Patches(transform(T, center[good]), unit @ T[:3, :3].T, length[good] / 4)


def _dominant_up(patches: _Patches, prior: NDArray[np.float64]) -> NDArray[np.float64] | None:
    near = patches.normals @ prior > np.cos(UPRIGHT_LIMIT)
    normals, areas = patches.normals[near], patches.areas[near]
    if areas.sum() < SMALLEST_FLOOR_M2:
        return None
    candidates = normals[np.argsort(-areas, kind="stable")[:: max(1, len(areas) // 400)]]
    within = (candidates @ normals.T) > np.cos(SAME_DIRECTION)
    up: NDArray[np.float64] = candidates[int(np.argmax(within @ areas))]
    for _ in range(10):
        close = normals @ up > np.cos(SAME_DIRECTION)
        up = (normals[close] * areas[close, None]).sum(axis=0)
        up /= np.linalg.norm(up)
    return _refined_on_levels(patches, up)


def _refined_on_levels(patches: _Patches, up: NDArray[np.float64]) -> NDArray[np.float64]:
    """Up from the floor's points: over metres they tell direction better than normals do."""
    floor = _floor_height(patches, up)
    if floor is None:
        return up
    on_floor = (np.abs(patches.points @ up - floor) < 0.04) & (
        patches.normals @ up > np.cos(2 * SAME_DIRECTION)
    )
    points = patches.points[on_floor]
    spread = np.linalg.svd(points - points.mean(axis=0), full_matrices=False)
    if len(points) < 50 or spread.S[1] / np.sqrt(len(points)) < 0.2:
        return up
    refined: NDArray[np.float64] = spread.Vh[2] * np.sign(spread.Vh[2] @ up)
    return refined if refined @ up > np.cos(SAME_DIRECTION) else up


def _floor_height(patches: _Patches, up: NDArray[np.float64]) -> float | None:
    level_ = patches.normals @ up > np.cos(2 * SAME_DIRECTION)
    heights, areas = patches.points[level_] @ up, patches.areas[level_]
    if areas.sum() < SMALLEST_FLOOR_M2:
        return None
    edges = np.arange(heights.min() - HEIGHT_BIN_M, heights.max() + 2 * HEIGHT_BIN_M, HEIGHT_BIN_M)
    histogram, _ = np.histogram(heights, edges, weights=areas)
    smooth = np.convolve(histogram, np.ones(3), "same")
    wanted = max(FLOOR_SHARE * smooth.max(), SMALLEST_FLOOR_M2)
    lowest = int(np.argmax(smooth >= wanted))
    if smooth[lowest] < wanted:
        return None
    peak = lowest + int(np.argmax(smooth[lowest : lowest + 4]))
    near = np.abs(heights - edges[peak] - HEIGHT_BIN_M / 2) < 1.5 * HEIGHT_BIN_M
    return float(np.average(heights[near], weights=areas[near]))


def _map_frame(
    T_source_base: NDArray[np.float64], up: NDArray[np.float64], floor: float
) -> NDArray[np.float64]:
    ahead = T_source_base[:3, 0] - up * (up @ T_source_base[:3, 0])
    if np.linalg.norm(ahead) < 0.1:
        ahead = T_source_base[:3, 2] - up * (up @ T_source_base[:3, 2])
    x = ahead / np.linalg.norm(ahead)
    R = np.stack([x, np.cross(up, x), up])
    origin = T_source_base[:3, 3] + up * (floor - up @ T_source_base[:3, 3])
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = R, -R @ origin
    return T
