"""One view as it is remembered, and where it would be had the robot stood elsewhere."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from afkb.flow import Detection, Hypothesis, OrientedBox, View
from afkb_mapping.geometry import transform_xy, wrap_angle, yaw_of
from afkb_mapping.memory.thinning import thinned_detection, thinned_view

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class RememberedView:
    """All that a map is built from: a view with what was detected in it and what follows.

    The view is placed in the map frame, and its detections stand where that pose puts them.
    """

    view: View
    detections: tuple[Detection, ...]
    hypotheses: tuple[Hypothesis, ...]

    def thinned(self) -> RememberedView:
        """What is kept of it. Raises `BadFrame` where that would be nothing."""
        detections = tuple(thinned_detection(d) for d in self.detections)
        return replace(self, view=thinned_view(self.view), detections=detections)

    @property
    def T_map_base(self) -> Array:
        """(4, 4) where the base stood."""
        assert self.view.T_map_base is not None
        return self.view.T_map_base

    def moved_to(self, T_map_base: Array) -> RememberedView:
        """The same view with its base at another pose (4, 4), all that it saw moved rigidly.

        Boxes stay upright: of a correction that also tilts, they follow the turn about z.
        """
        if np.array_equal(T_map_base, self.T_map_base):
            return self
        T = T_map_base @ np.linalg.inv(self.T_map_base)
        view = replace(self.view, T_map_base=T_map_base)
        return replace(self, view=view, detections=tuple(_moved(d, T) for d in self.detections))

    def is_of(self, view: View) -> bool:
        """Whether it is what is remembered of this view: the same odometry, depth and scan."""
        mine, other = self.view, thinned_view(view)
        return (
            mine.stamp == other.stamp
            and np.array_equal(mine.T_odom_base, other.T_odom_base)
            and _same(mine.depth_m, other.depth_m)
            and _same(_ranges(mine), _ranges(other))
        )


def _ranges(view: View) -> NDArray[np.float32] | None:
    return None if view.scan is None else view.scan.ranges_m


def _same(first: NDArray[np.float32] | None, second: NDArray[np.float32] | None) -> bool:
    if first is None or second is None:
        return first is second
    return np.array_equal(first, second, equal_nan=True)


def _moved(detection: Detection, T: Array) -> Detection:
    R = T[:3, :3]
    segment = detection.segment_xy
    return replace(
        detection,
        box=_moved_box(detection.box, T),
        position_xyz=R @ detection.position_xyz + T[:3, 3],
        covariance_xyz=R @ detection.covariance_xyz @ R.T,
        footprint_xy=transform_xy(T, detection.footprint_xy),
        segment_xy=None if segment is None else transform_xy(T, segment),
        parts=tuple(_moved(part, T) for part in detection.parts),
    )


def _moved_box(box: OrientedBox, T: Array) -> OrientedBox:
    x, y, z = (T[:3, :3] @ np.asarray(box.center_xyz) + T[:3, 3]).tolist()
    return OrientedBox((x, y, z), box.size_xyz, wrap_angle(box.yaw + yaw_of(T)))
