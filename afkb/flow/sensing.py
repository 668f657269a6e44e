"""What a sensor gives at one moment: camera, depth, laser scan, odometry."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from afkb.errors import BadFrame


@dataclass(frozen=True, slots=True)
class PinholeCamera:
    """Intrinsics of an undistorted camera, pixels; optical frame: x right, y down, z forward.

    Raises `BadFrame` where a size or focal length is not positive and finite.
    """

    width: int
    height: int
    fx: float
    fy: float
    cx: float
    cy: float

    def __post_init__(self) -> None:
        sizes = (self.width, self.height, self.fx, self.fy)
        if not all(math.isfinite(v) and v > 0 for v in sizes):
            raise BadFrame(
                f"camera intrinsics {self.width}x{self.height} fx={self.fx} fy={self.fy}: "
                "sizes and focal lengths must be positive"
            )
        if not (math.isfinite(self.cx) and math.isfinite(self.cy)):
            raise BadFrame(f"camera intrinsics cx={self.cx} cy={self.cy}: must be finite")

    @property
    def matrix(self) -> NDArray[np.float64]:
        """The 3x3 camera matrix K."""
        return np.array([[self.fx, 0, self.cx], [0, self.fy, self.cy], [0, 0, 1]], dtype=np.float64)


@dataclass(frozen=True, slots=True, eq=False)
class LaserScan:
    """One planar scan in the laser frame (x ahead, z up, counter-clockwise, radians).

    `ranges_m`: (N,) float32, m; a beam without a return is inf or NaN or outside
    [`range_min_m`, `range_max_m`].
    """

    ranges_m: NDArray[np.float32]
    angle_min: float
    angle_increment: float
    range_min_m: float
    range_max_m: float

    def __post_init__(self) -> None:
        if self.ranges_m.ndim != 1 or self.ranges_m.size == 0:
            raise BadFrame(f"laser scan of shape {self.ranges_m.shape}: expected (N,), N > 0")
        if not (math.isfinite(self.angle_min) and math.isfinite(self.angle_increment)):
            raise BadFrame("laser scan: angle_min and angle_increment must be finite")

    @property
    def angles(self) -> NDArray[np.float64]:
        """(N,) bearing of each beam in the laser frame, rad."""
        count = np.arange(self.ranges_m.size, dtype=np.float64)
        return self.angle_min + self.angle_increment * count

    @property
    def hit(self) -> NDArray[np.bool_]:
        """(N,) whether each beam came back from something in range."""
        r = self.ranges_m
        with np.errstate(invalid="ignore"):
            return np.isfinite(r) & (r >= self.range_min_m) & (r < self.range_max_m)

    @property
    def points_xy(self) -> NDArray[np.float64]:
        """(M, 2) returned points in the laser frame, m."""
        hit = self.hit
        r, a = self.ranges_m[hit].astype(np.float64), self.angles[hit]
        return np.column_stack([r * np.cos(a), r * np.sin(a)])


def _checked_transform(name: str, T: NDArray[np.float64]) -> None:
    if T.shape != (4, 4) or not np.isfinite(T).all():
        raise BadFrame(f"{name}: expected a finite 4x4 transform, got {np.asarray(T).tolist()}")
    R = T[:3, :3]
    if not np.allclose(R @ R.T, np.eye(3), atol=1e-2) or np.linalg.det(R) < 0:
        raise BadFrame(f"{name}: its 3x3 part is not a rotation")


@dataclass(frozen=True, slots=True, eq=False, weakref_slot=True)
class View:
    """Everything sensed at one moment, and nothing else: the unit that flows.

    Transforms are 4x4, `T_a_b` takes points of frame b to frame a, metres.

    - `index`: position in the recording, from 0; `stamp`: s, the source's clock.
    - `T_odom_base`: odometry or given pose of the base (x ahead, z up at rest). A recording that
      has only camera poses uses the camera's body frame as its base (`has_base` False).
    - `depth_m`: (H, W) float32, metres along the optical axis, 0 where nothing came back.
    - `color`: (H, W, 3) uint8 RGB, registered to depth, or None.
    - `T_map_base`: where mapping placed the view (levelled and registered); None from a source.

    Raises `BadFrame` where a shape is wrong, a transform is not rigid, or depth is all zero.
    """

    index: int
    stamp: float
    T_odom_base: NDArray[np.float64]
    depth_m: NDArray[np.float32] | None = None
    camera: PinholeCamera | None = None
    T_base_camera: NDArray[np.float64] | None = None
    color: NDArray[np.uint8] | None = None
    scan: LaserScan | None = None
    T_base_laser: NDArray[np.float64] | None = None
    has_base: bool = True
    T_map_base: NDArray[np.float64] | None = None

    def __post_init__(self) -> None:
        if not math.isfinite(self.stamp):
            raise BadFrame(f"stamp {self.stamp}: must be finite")
        for name in ("T_odom_base", "T_base_camera", "T_base_laser", "T_map_base"):
            T = getattr(self, name)
            if T is not None:
                _checked_transform(name, T)
        if self.depth_m is not None:
            self._check_depth(self.depth_m)
        if self.scan is not None and self.T_base_laser is None:
            raise BadFrame("laser scan without T_base_laser: where is the laser on the robot?")
        if self.depth_m is None and self.scan is None:
            raise BadFrame("neither depth nor a laser scan")

    def _check_depth(self, depth_m: NDArray[np.float32]) -> None:
        if self.camera is None or self.T_base_camera is None:
            raise BadFrame("depth without a camera: intrinsics and T_base_camera are needed")
        expected = (self.camera.height, self.camera.width)
        if depth_m.shape != expected or depth_m.dtype != np.float32:
            raise BadFrame(
                f"depth is {depth_m.shape} {depth_m.dtype}, the camera says {expected} float32 m"
            )
        if not np.any(depth_m > 0):
            raise BadFrame("depth has no valid pixel")

    @property
    def T_map_camera(self) -> NDArray[np.float64]:
        """Camera in the map frame; only for views with depth that mapping has placed."""
        if self.T_map_base is None or self.T_base_camera is None:
            raise BadFrame("this view has no camera or has not been placed in the map")
        return self.T_map_base @ self.T_base_camera

    @property
    def T_map_laser(self) -> NDArray[np.float64]:
        """Laser in the map frame; only for views with a scan that mapping has placed."""
        if self.T_map_base is None or self.T_base_laser is None:
            raise BadFrame("this view has no laser or has not been placed in the map")
        return self.T_map_base @ self.T_base_laser


@dataclass(frozen=True, slots=True)
class SkippedFrame:
    """A frame that a source could not turn into a `View`: counted, reported, not fatal."""

    index: int
    where: str
    why: str
