"""The little geometry that the filtrations need: heights and horizontal distances, m."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from afkb.flow import Detection

SAME_LEVEL_M = 0.08
"""Bottoms and tops that differ by less are level: depth steps and noise of a sensor at 3 m."""


def top_height(detection: Detection, support_feature: str) -> float:
    """Height of its upper surface if it affords support, else of the top of its box, m."""
    if detection.affords(support_feature):
        return float(detection.position_xyz[2])
    return detection.box.top


def distance_xy(a: Detection, b: Detection) -> float:
    """Horizontal distance between two positions, m."""
    dx, dy = a.position_xyz[:2] - b.position_xyz[:2]
    return math.hypot(float(dx), float(dy))


def distance_to_box(detection: Detection, other: Detection) -> float:
    """Horizontal distance from a detection's position to the other's box, 0 inside, m."""
    dx, dy = (float(v) for v in detection.position_xyz[:2] - other.box.center_xyz[:2])
    cos, sin = math.cos(other.box.yaw), math.sin(other.box.yaw)
    along, across = dx * cos + dy * sin, dy * cos - dx * sin
    half_x, half_y = other.box.size_xyz[0] / 2, other.box.size_xyz[1] / 2
    return math.hypot(max(0.0, abs(along) - half_x), max(0.0, abs(across) - half_y))


def groups_of(indexes: Sequence[int], belong: Callable[[int, int], bool]) -> list[tuple[int, ...]]:
    """Greedy groups in which every two members belong together, in order of first member."""
    groups: list[list[int]] = []
    for index in indexes:
        for group in groups:
            if all(belong(index, member) for member in group):
                group.append(index)
                break
        else:
            groups.append([index])
    return [tuple(group) for group in groups]
