"""A picture of what was detected in a view, for a person to check."""

from __future__ import annotations

from collections.abc import Sequence

import cv2
import numpy as np
from numpy.typing import NDArray

from afkb.flow import Detection, View

Image = NDArray[np.uint8]

NEAR_M, FAR_M = 0.4, 5.0
"""Depths that are drawn lightest and darkest."""
SURE = 0.5
"""Features below this probability are not written beside a thing."""
TINT = 0.45
NAMED, MOST_NAMES = "Ability", 2
"""Grasps are left to the table: there are too many to be read in a picture."""
SUPPORT, HOLLOW, UPRIGHT, BODY, OTHER = (
    (60, 160, 60),
    (40, 60, 220),
    (180, 80, 160),
    (210, 140, 40),
    (120, 120, 120),
)
"""Colours (blue, green, red): supports, containers, bounds, other bodies, and the rest."""


def overlay(view: View, detections: Sequence[Detection], sure: float = SURE) -> Image:
    """(H, W, 3) uint8 BGR: depth in grey, what was detected in colour, with its features.

    Raises `ValueError` for a view without depth.
    """
    if view.depth_m is None:
        raise ValueError("a view without depth has no picture")
    picture = _grey(view.depth_m)
    drawn = [d for d in detections if _is_drawn(d, sure)]
    for detection in drawn:
        _tint(picture, detection, _color(detection, sure))
    for detection in drawn:
        _name(picture, detection, _color(detection, sure), sure)
    return picture


def _is_drawn(detection: Detection, sure: float) -> bool:
    """The floor and what is faint would hide the rest."""
    return max(detection.affordances.values()) >= sure and not detection.measures.get("is_floor")


def _grey(depth_m: NDArray[np.float32]) -> Image:
    near = np.clip((FAR_M - depth_m) / (FAR_M - NEAR_M), 0, 1)
    grey = np.where(depth_m > 0, 60 + 180 * near, 20).astype(np.uint8)
    return np.repeat(grey[:, :, None], 3, axis=2)


def _color(detection: Detection, sure: float) -> tuple[int, int, int]:
    if detection.segment_xy is not None:
        return UPRIGHT
    if detection.affords("ContainAbility", sure):
        return HOLLOW
    if detection.affords("SupportAbility", sure):
        return SUPPORT
    return BODY if detection.pixels is not None else OTHER


def _tint(picture: Image, detection: Detection, color: tuple[int, int, int]) -> None:
    if detection.pixels is not None:
        flat = picture.reshape(-1, 3)
        mixed = (1 - TINT) * flat[detection.pixels] + TINT * np.array(color)
        flat[detection.pixels] = mixed.astype(np.uint8)
    if detection.image_box is not None:
        u0, v0, u1, v1 = detection.image_box
        cv2.rectangle(picture, (u0, v0), (u1 - 1, v1 - 1), color, 1)


def _name(picture: Image, detection: Detection, color: tuple[int, int, int], sure: float) -> None:
    if detection.image_box is None:
        return
    u0, v0, _, _ = detection.image_box
    named = sorted(detection.affordances.items(), key=lambda pair: (-pair[1], pair[0]))
    named = [(name, p) for name, p in named if p >= sure and name.endswith(NAMED)]
    words = [f"{name.removesuffix(NAMED)} {p:.2f}" for name, p in named[:MOST_NAMES]]
    width = picture.shape[1]
    scale = max(0.35, width / 1600)
    at = (min(u0 + 2, width - 60), max(v0 - 3, 10))
    cv2.putText(
        picture, ", ".join(words), at, cv2.FONT_HERSHEY_SIMPLEX, scale, color, 1, cv2.LINE_AA
    )
