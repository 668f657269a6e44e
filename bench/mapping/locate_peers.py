"""Peers of self-localisation that know no odds: matching of scans, and of clouds by features."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import distance_transform_edt, gaussian_filter
from scipy.signal import fftconvolve

from afkb.flow import View
from afkb_mapping.geometry import yaw_of
from afkb_mapping.grid.occupancy import RESOLUTION_M as CELL_M
from afkb_mapping.localisation.bands import FREE, STANDS, HeightBands
from afkb_mapping.localisation.readings import readings_of
from afkb_mapping.localisation.sensor_model import HIT
from afkb_mapping.localisation.slabs import SLAB_M
from bench.mapping.locate_changes import FLOOR_SLABS

Array = NDArray[np.float64]
Pose = tuple[float, float, float]
Peer = Callable[[View], Pose | None]

FIELD_SIGMA_M = 0.1
"""Of the likelihood field (Thrun et al., §6.4): two cells."""
TURN_DEG = 3
VOXEL_M = 0.1
"""Of the clouds: twice that for normals, five times for features, as Open3D's tutorial has it."""
TRIALS, CONFIDENCE = 50_000, 0.999
"""Of RANSAC: so many at most, fewer if one is so surely the best."""
ALIKE = 0.9
"""Of the lengths of two edges that RANSAC takes for one: the tutorial's."""
TUPLES, ITERATIONS = 1000, 64
"""Of FGR: its defaults."""
INWARD_CELLS = 2.0
"""Around a point of the map, where it is looked for which side of it is free."""


def peers_in(bands: HeightBands) -> Iterator[tuple[str, str, Peer]]:
    """Each peer with its name and what it senses; built only when it is its turn."""
    matching = scan_matching(bands)
    yield "scan matching, laser", "laser", matching
    nonsense = "laser, 60 % of the beams nonsense"
    yield "scan matching, laser, nonsense", nonsense, matching
    yield "scan matching, depth from above", "depth", matching
    yield "Open3D FPFH and RANSAC, depth", "depth", feature_matching(bands, fast=False)
    yield "Open3D FPFH and FGR, depth", "depth", feature_matching(bands, fast=True)


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

    target = _map_cloud(bands)
    target_features = _features(target)
    match = _by_fgr if fast else _by_ransac

    def locate(view: View) -> Pose | None:
        assert view.T_base_camera is not None
        o3d.utility.random.seed(1)
        source = _cloud(_points(view))
        source.orient_normals_towards_camera_location(view.T_base_camera[:3, 3])
        if len(source.points) < 10:
            return None
        T = match(source, target, _features(source), target_features).transformation
        return float(T[0, 3]), float(T[1, 3]), yaw_of(T)

    return locate


def _by_ransac(source: Any, target: Any, features: Any, target_features: Any) -> Any:
    import open3d as o3d

    reg = o3d.pipelines.registration
    return reg.registration_ransac_based_on_feature_matching(
        source,
        target,
        features,
        target_features,
        True,
        1.5 * VOXEL_M,
        ransac_n=3,
        checkers=[
            reg.CorrespondenceCheckerBasedOnEdgeLength(ALIKE),
            reg.CorrespondenceCheckerBasedOnDistance(1.5 * VOXEL_M),
        ],
        criteria=reg.RANSACConvergenceCriteria(TRIALS, CONFIDENCE),
    )


def _by_fgr(source: Any, target: Any, features: Any, target_features: Any) -> Any:
    import open3d as o3d

    reg = o3d.pipelines.registration
    option = reg.FastGlobalRegistrationOption(
        maximum_correspondence_distance=0.5 * VOXEL_M,
        iteration_number=ITERATIONS,
        maximum_tuple_count=TUPLES,
    )
    return reg.registration_fgr_based_on_feature_matching(
        source, target, features, target_features, option
    )


def _points(view: View) -> Array:
    """(N, 3) m, base frame."""
    camera, depth, T = view.camera, view.depth_m, view.T_base_camera
    assert camera is not None and depth is not None and T is not None
    v, u = np.nonzero(depth[::4, ::4] > 0)
    z = depth[4 * v, 4 * u].astype(np.float64)
    rays = [(4 * u - camera.cx) / camera.fx, (4 * v - camera.cy) / camera.fy, np.ones(len(u))]
    points: Array = (np.column_stack(rays) * z[:, None]) @ T[:3, :3].T + T[:3, 3]
    return points


def _map_cloud(bands: HeightBands) -> Any:
    """What stands in a map, as a cloud whose normals point to where it is free."""
    import open3d as o3d

    solid = bands.slabs == STANDS
    solid[..., :FLOOR_SLABS] = False
    xyz = (np.argwhere(solid)[:, [1, 0, 2]] + 0.5) * [CELL_M, CELL_M, SLAB_M]
    cloud = _cloud(xyz)
    free = gaussian_filter((bands.slabs == FREE).astype(np.float32), INWARD_CELLS)
    cols, rows, slabs = (np.asarray(cloud.points) / [CELL_M, CELL_M, SLAB_M]).astype(int).T
    along_y, along_x, up = (g[rows, cols, slabs] for g in np.gradient(free))
    normals = np.asarray(cloud.normals)
    inwards = (normals * np.column_stack([along_x, along_y, up])).sum(axis=1)
    cloud.normals = o3d.utility.Vector3dVector(np.where(inwards[:, None] < 0, -normals, normals))
    return cloud.translate([*bands.origin_xy, 0.0])


def _cloud(points: Array) -> Any:
    """Points (N, 3), m, one a voxel, with normals."""
    import open3d as o3d

    cloud = o3d.geometry.PointCloud(o3d.utility.Vector3dVector(points)).voxel_down_sample(VOXEL_M)
    cloud.estimate_normals(o3d.geometry.KDTreeSearchParamHybrid(2 * VOXEL_M, 30))
    return cloud


def _features(cloud: Any) -> Any:
    import open3d as o3d

    near = o3d.geometry.KDTreeSearchParamHybrid(5 * VOXEL_M, 100)
    return o3d.pipelines.registration.compute_fpfh_feature(cloud, near)  # type: ignore[call-arg]
