"""Peers of self-localisation that know no odds: matching of scans, and of clouds by features."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import distance_transform_edt
from scipy.signal import fftconvolve

from afkb.flow import View
from afkb_mapping.geometry import yaw_of
from afkb_mapping.localisation.bands import FREE, STANDS, HeightBands
from afkb_mapping.localisation.readings import readings_of
from afkb_mapping.localisation.sensor_model import HIT
from afkb_mapping.localisation.slabs import SLAB_M
from afkb_mapping.occupancy import RESOLUTION_M as CELL_M

Array = NDArray[np.float64]
Pose = tuple[float, float, float]
Peer = Callable[[View], Pose | None]

FIELD_SIGMA_M = 0.1
"""Of the likelihood field (Thrun et al., §6.4): two cells."""
TURN_DEG = 3
VOXEL_M = 0.1
"""Of the clouds: twice that for normals, five times for features, as Open3D's tutorial has it."""


def scan_matching(bands: HeightBands) -> Peer:
    """Ends of all readings, as seen from above, where they fit the map best (Olson 2009)."""
    solid = (bands.scan == STANDS) | (bands.slabs[..., 2:] == STANDS).any(axis=2)
    apart = distance_transform_edt(~solid) * CELL_M
    field = np.exp(-0.5 * (apart / FIELD_SIGMA_M) ** 2)
    free = (bands.scan == FREE) | ((bands.slabs == FREE).any(axis=2) & ~solid)

    def locate(view: View) -> Pose | None:
        read = readings_of(view, np.eye(4))
        met = read.kind == HIT
        ends = read.rays()[met] * read.range_m[met, None] + read.origins_xyz[read.origin[met]]
        if not len(ends):
            return None
        best, found = -math.inf, (0.0, 0.0, 0.0)
        for yaw in np.radians(np.arange(0, 360, TURN_DEG)):
            row, col, score = _best_shift(field, free, ends[:, :2], float(yaw))
            if score > best:
                x, y = bands.origin_xy + (np.array([col, row]) + 0.5) * CELL_M
                best, found = score, (float(x), float(y), float(yaw))
        return found

    return locate


def _best_shift(
    field: Array, free: NDArray[np.bool_], ends: Array, yaw: float
) -> tuple[int, int, float]:
    """Row and column of the free cell about which turned ends lie best, and how well."""
    c, s = math.cos(yaw), math.sin(yaw)
    cells = np.round(ends @ np.array([[c, s], [-s, c]]) / CELL_M).astype(int)
    reach = int(np.abs(cells).max()) + 1
    image = np.zeros((2 * reach + 1, 2 * reach + 1))
    np.add.at(image, (cells[:, 1] + reach, cells[:, 0] + reach), 1.0)
    scores = fftconvolve(np.pad(field, reach), image[::-1, ::-1], mode="valid")
    scores[~free] = -np.inf
    row, col = np.unravel_index(int(np.argmax(scores)), scores.shape)
    return int(row), int(col), float(scores[row, col])


def feature_matching(bands: HeightBands, fast: bool) -> Peer:
    """Open3D's global registration of clouds: FPFH with RANSAC, or with FGR (`fast`)."""
    import open3d as o3d

    reg = o3d.pipelines.registration
    rows, cols, slabs = np.nonzero(bands.slabs == STANDS)
    xyz = np.column_stack([cols, rows, slabs]) + 0.5
    points = xyz * [CELL_M, CELL_M, SLAB_M] + [*bands.origin_xy, 0.0]
    target, target_features = _described(points, None)

    def locate(view: View) -> Pose | None:
        assert view.camera is not None and view.depth_m is not None
        o3d.utility.random.seed(1)
        source, features = _described(_points(view), view.T_base_camera)
        if len(source.points) < 10:
            return None
        if fast:
            found = reg.registration_fgr_based_on_feature_matching(
                source, target, features, target_features
            )
        else:
            found = reg.registration_ransac_based_on_feature_matching(
                source, target, features, target_features, True, 1.5 * VOXEL_M
            )
        T = found.transformation
        return float(T[0, 3]), float(T[1, 3]), yaw_of(T)

    return locate


def _points(view: View) -> Array:
    """(N, 3) m, base frame."""
    camera, depth, T = view.camera, view.depth_m, view.T_base_camera
    assert camera is not None and depth is not None and T is not None
    v, u = np.nonzero(depth[::4, ::4] > 0)
    z = depth[4 * v, 4 * u].astype(np.float64)
    rays = [(4 * u - camera.cx) / camera.fx, (4 * v - camera.cy) / camera.fy, np.ones(len(u))]
    points: Array = (np.column_stack(rays) * z[:, None]) @ T[:3, :3].T + T[:3, 3]
    return points


def _described(points: Array, T_camera: Array | None):  # type: ignore[no-untyped-def]
    """A cloud with normals, towards the camera if there is one, and its features."""
    import open3d as o3d

    cloud = o3d.geometry.PointCloud(o3d.utility.Vector3dVector(points)).voxel_down_sample(VOXEL_M)
    cloud.estimate_normals(o3d.geometry.KDTreeSearchParamHybrid(2 * VOXEL_M, 30))
    if T_camera is not None:
        cloud.orient_normals_towards_camera_location(T_camera[:3, 3])
    near = o3d.geometry.KDTreeSearchParamHybrid(5 * VOXEL_M, 100)
    features = o3d.pipelines.registration.compute_fpfh_feature(cloud, near)  # type: ignore[call-arg]
    return cloud, features
