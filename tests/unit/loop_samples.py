"""A robot's stations in a small flat of walls and landmarks, with odometry that drifts."""

from itertools import pairwise

import numpy as np

from afkb_mapping.geometry import T_from_xy_yaw, inverse, transform_xy
from afkb_mapping.loops.landmarks import Landmarks
from afkb_mapping.loops.stations import Station
from afkb_mapping.placing.scan_surface import SurfacePoints

KINDS = 6
SEEN_M = 4.0


def landmarks(rows, weight=1.0):
    """Things (x, y, top, kind), m; each of one kind for sure, seen whole."""
    rows = np.array(rows, float).reshape(-1, 4)
    belief = np.eye(KINDS)[rows[:, 3].astype(int)]
    n = len(rows)
    return Landmarks(
        xy=rows[:, :2],
        sigma_m=np.full(n, 0.05),
        top_m=rows[:, 2],
        is_surface=np.ones(n, bool),
        size_m=np.tile([0.8, 0.6], (n, 1)),
        whole=np.ones(n, bool),
        affords=belief[:, :3].copy(),
        root_belief=belief,
        weight=np.full(n, weight),
    )


def room(x, y, width, depth, door_side):
    """Walls (x0, y0, x1, y1) of a room, with a doorway in the middle of its right or left side."""
    x1, y1, middle = x + width, y + depth, y + depth / 2
    walls = [(x, y, x1, y), (x, y1, x1, y1)]
    for side, at in (("left", x), ("right", x1)):
        if side == door_side:
            walls += [(at, y, at, middle - 0.5), (at, middle + 0.5, at, y1)]
        else:
            walls.append((at, y, at, y1))
    return walls


def cast(walls, eye, beams=180):
    """Surface points with normals seen all around an eye, world frame."""
    bearings = np.linspace(-np.pi, np.pi, beams, endpoint=False)
    d = np.column_stack([np.cos(bearings), np.sin(bearings)])
    a, b = np.array(walls, float)[:, :2], np.array(walls, float)[:, 2:]
    e = b - a
    cross = d[:, None, 0] * e[None, :, 1] - d[:, None, 1] * e[None, :, 0]
    off = a - eye
    with np.errstate(divide="ignore", invalid="ignore"):
        t = (off[None, :, 0] * e[None, :, 1] - off[None, :, 1] * e[None, :, 0]) / cross
        s = (off[None, :, 0] * d[:, None, 1] - off[None, :, 1] * d[:, None, 0]) / cross
    t = np.where((t > 0.05) & (s >= 0) & (s <= 1), t, np.inf)
    wall, r = t.argmin(axis=1), t.min(axis=1)
    hit = np.isfinite(r) & (r < 8.0)
    along = e[wall] / np.linalg.norm(e[wall], axis=1, keepdims=True)
    normals = np.column_stack([-along[:, 1], along[:, 0]])
    normals *= -np.sign((normals * d).sum(axis=1, keepdims=True))
    points = eye + np.where(hit, r, 0.0)[:, None] * d
    return points[hit], normals[hit]


def station(index, T_true, T_drifted, walls, things, has_laser=False):
    """What is seen from a true pose, thought to be another; things are hidden by no wall here."""
    back = inverse(T_true)
    points, normals = cast(walls, T_true[:2, 3])
    near = np.hypot(*(things.xy - T_true[:2, 3]).T) < SEEN_M
    surface = SurfacePoints.of_laser(transform_xy(back, points), normals @ back[:2, :2].T)
    seen = things[near].seen_from(back)
    T = T_drifted
    return Station(index, float(index), T, T, T, surface, has_laser, np.zeros(2), seen)


def tour(waypoints, walls, things, drift=(0.0, 0.0), has_laser=False):
    """Stations along waypoints (x, y), every 0.5 m, and the true poses.

    `drift`: m ahead per m and rad per m that odometry errs by.
    """
    true, drifted = [], []
    T = None
    for (x0, y0), (x1, y1) in pairwise(waypoints):
        steps = max(1, round(np.hypot(x1 - x0, y1 - y0) / 0.5))
        yaw = np.arctan2(y1 - y0, x1 - x0)
        for k in range(steps):
            f = k / steps
            true.append(T_from_xy_yaw(x0 + f * (x1 - x0), y0 + f * (y1 - y0), yaw))
    for before, after in zip([None, *true], true, strict=False):
        if before is None:
            T = after
        else:
            step = inverse(before) @ after
            m = float(np.hypot(*step[:2, 3]))
            T = T @ step @ T_from_xy_yaw(drift[0] * m, 0.0, drift[1] * m)
        drifted.append(T)
    stations = [
        station(i, a, b, walls, things, has_laser)
        for i, (a, b) in enumerate(zip(true, drifted, strict=True))
    ]
    return stations, true


def errors(poses, true):
    """(N,) distance of each pose from the true one, m."""
    return np.array([np.hypot(*(a[:2, 3] - b[:2, 3])) for a, b in zip(poses, true, strict=True)])
