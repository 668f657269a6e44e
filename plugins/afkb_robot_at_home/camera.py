"""Where a camera of the robot looks, and which way up its images are stored."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from afkb.errors import SourceError
from afkb.flow import PinholeCamera
from afkb_mapping.optical import T_BODY_OPTICAL

# Quarter turn of an image to the left: new x is old y, new y is minus old x.
_QUARTER: NDArray[np.float64] = np.array(
    [[0, -1, 0, 0], [1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]], dtype=np.float64
)
_LANDSCAPE = (286.441384, 271.36999, 157.3245865, 120.0802295)
"""fx, fy, cx, cy of a camera of the robot at 320x240, as a reader of others states them
(github.com/phir2-lab/robotathome_at_ros)."""
_LANDSCAPE_SIZE = (320, 240)


def T_from_ypr(pose: tuple[float, ...]) -> NDArray[np.float64]:
    """Transform (4, 4) of x, y, z (m), yaw, pitch, roll (rad), turned in that order (MRPT)."""
    from scipy.spatial.transform import Rotation

    T = np.eye(4)
    T[:3, :3] = Rotation.from_euler("ZYX", pose[3:]).as_matrix()
    T[:3, 3] = pose[:3]
    return T


def T_upright(T_sensor: NDArray[np.float64]) -> NDArray[np.float64]:
    """The optical frame of a sensor's stored images, which are upright.

    The cameras are mounted on their sides and the authors turned the images: of the four ways to
    turn one, the one whose image-down points down.
    """
    turned = [T_sensor @ T_BODY_OPTICAL @ np.linalg.matrix_power(_QUARTER, k) for k in range(4)]
    return min(turned, key=lambda T: float(T[2, 1]))


def camera_of_images(
    size: tuple[int, int], given: tuple[float, float, float, float] | None, where: str
) -> PinholeCamera:
    """Intrinsics of stored images; those of an upright image are the landscape's, turned left."""
    fx, fy, cx, cy = _LANDSCAPE
    if given is not None:
        return PinholeCamera(*size, *given)
    if size == _LANDSCAPE_SIZE:
        return PinholeCamera(*size, fx, fy, cx, cy)
    if size == _LANDSCAPE_SIZE[::-1]:
        return PinholeCamera(*size, fy, fx, cy, size[1] - 1 - cx)
    raise SourceError(
        f"{where}: depth is {size[0]}x{size[1]}; the robot's cameras give 240x320: "
        "give the option intrinsics=fx,fy,cx,cy"
    )
