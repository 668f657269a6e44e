"""Pictures that a person can check: what detectors say, drawn over the depth image."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from afkb.flow import Detection, View
from afkb_mapping.one_per_thing import one_per_thing
from bench.detectors.seen import CLAIMED, Run

PICTURES = 8
"""Views drawn of each recording, evenly over it."""
FAR_M = 5.0
COLORS = {
    "ContainAbility": (60, 120, 255),
    "SupportAbility": (80, 220, 80),
    "PassAbility": (255, 80, 255),
    "BlockAbility": (160, 160, 160),
    "DisposeAbility": (255, 200, 60),
}
"""What is drawn, BGR; of a detection that claims several the first."""
FLOOR_COLOR = (70, 110, 70)
Image = NDArray[np.uint8]


def draw_views(name: str, views: Iterable[View], seen: Run, folder: Path) -> int:
    """Write `NAME-INDEX.png` for some of the views that were seen; returns how many."""
    folder.mkdir(parents=True, exist_ok=True)
    wanted = {i for i, _ in seen.views[:: max(1, -(-len(seen.views) // PICTURES))]}
    said, drawn = dict(seen.views), 0
    for view in views:
        if view.index in wanted and view.index in said:
            path = folder / f"{name}-{view.index:04d}.png"
            cv2.imwrite(str(path), overlay(view, one_per_thing(said[view.index])))
            drawn += 1
    return drawn


def overlay(view: View, detections: Iterable[Detection]) -> Image:
    """(H, W, 3) BGR: depth in grey, footprints of surfaces as dots, boxes of what isn't flat."""
    assert view.depth_m is not None
    grey = 230 * (1 - np.clip(view.depth_m / FAR_M, 0, 1)) * (view.depth_m > 0)
    picture = cv2.cvtColor(grey.astype(np.uint8), cv2.COLOR_GRAY2BGR)
    for d in sorted(detections, key=lambda d: -len(d.footprint_xy)):
        feature = next((name for name in COLORS if d.affords(name, CLAIMED)), None)
        if feature is None:
            continue
        color = FLOOR_COLOR if d.measures.get("is_floor") else COLORS[feature]
        if feature == "SupportAbility":
            _dots(picture, view, d, color)
        else:
            _box(picture, view, d, color)
        if d.segment_xy is None and not d.measures.get("is_floor"):
            _words(picture, view, d, f"{feature[:4]} {d.affordances[feature]:.2f}", color)
    return np.asarray(picture, np.uint8)


def _dots(picture: Image, view: View, d: Detection, color: tuple[int, int, int]) -> None:
    flat = np.full((len(d.footprint_xy), 1), d.box.top)
    for u, v in _pixels(np.hstack([d.footprint_xy, flat]), view):
        cv2.circle(picture, (u, v), 1, color, -1)


def _box(picture: Image, view: View, d: Detection, color: tuple[int, int, int]) -> None:
    """The twelve edges; an edge with an end behind the camera is left out."""
    corners = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
    c, s = np.cos(d.box.yaw), np.sin(d.box.yaw)
    R = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    points = (corners * d.box.size_xyz) @ R.T + d.box.center_xyz
    for i in range(8):
        for step in (1, 2, 4):
            ends = _pixels(points[[i, i | step]], view)
            if not i & step and len(ends) == 2:
                cv2.line(picture, ends[0], ends[1], color, 1, cv2.LINE_AA)


def _words(
    picture: Image, view: View, d: Detection, text: str, color: tuple[int, int, int]
) -> None:
    for u, v in _pixels(np.array([[*d.box.center_xyz[:2], d.box.top]]), view):
        cv2.putText(picture, text, (u - 30, v - 3), cv2.FONT_HERSHEY_SIMPLEX, 0.35, (0, 0, 0), 3)
        cv2.putText(picture, text, (u - 30, v - 3), cv2.FONT_HERSHEY_SIMPLEX, 0.35, color, 1)


def _pixels(points: NDArray[np.float64], view: View) -> list[tuple[int, int]]:
    """Where points of the map frame are in the image; those behind the camera are left out."""
    assert view.camera is not None
    T = np.linalg.inv(view.T_map_camera)
    p = points @ T[:3, :3].T + T[:3, 3]
    p = p[p[:, 2] > 0.1]
    u = view.camera.fx * p[:, 0] / p[:, 2] + view.camera.cx
    v = view.camera.fy * p[:, 1] / p[:, 2] + view.camera.cy
    return [
        (int(a), int(b)) for a, b in zip(np.clip(u, -9e3, 9e3), np.clip(v, -9e3, 9e3), strict=True)
    ]
