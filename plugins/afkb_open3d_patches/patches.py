"""Open3D's planar patches of a depth image, and the pixels that lie on each."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from afkb.flow import View
from afkb_mapping.sensor_noise import depth_sigma

THIN = 4
"""Every such row and column is taken: patches of all pixels take twenty times as long."""
NEIGHBOURS = 20
"""Of a point, for its normal and for growing patches."""
LEAST_POINTS = 20
WITHIN_SIGMAS = 3.0


@dataclass(frozen=True, slots=True, eq=False)
class Patch:
    """A planar patch: normal towards the camera (3,), points (N, 3), map frame, m, and pixels.

    `depth_m` (N,); `pixels` (N,) int32: flat indexes into the depth image, every THIN-th only.
    """

    normal: NDArray[np.float64]
    points: NDArray[np.float64]
    depth_m: NDArray[np.float64]
    pixels: NDArray[np.int32]


def planar_patches(view: View) -> Iterator[Patch]:
    """Patches of a placed view's depth (Araújo and Oliveira, 2020), larger ones first.

    A point goes to the first patch whose box holds it, noise allowed for.
    """
    import open3d as o3d

    points, depths, pixels = _points(view)
    if len(points) < LEAST_POINTS:
        return
    cloud = o3d.geometry.PointCloud(o3d.utility.Vector3dVector(points))
    search = o3d.geometry.KDTreeSearchParamKNN(NEIGHBOURS)
    cloud.estimate_normals(search)
    eye = view.T_map_camera[:3, 3]
    cloud.orient_normals_towards_camera_location(eye)
    boxes = cloud.detect_planar_patches(
        normal_variance_threshold_deg=60,
        coplanarity_deg=75,
        outlier_ratio=0.75,
        min_plane_edge_length=0.0,
        min_num_points=LEAST_POINTS,
        search_param=search,
    )
    free = np.ones(len(points), bool)
    for box in sorted(boxes, key=lambda b: -b.extent[0] * b.extent[1]):
        along = np.abs((points - box.center) @ box.R)
        half = np.asarray(box.extent) / 2
        on = free & (along[:, 0] <= half[0]) & (along[:, 1] <= half[1])
        if not on.any():
            continue
        # the median of what lies under the box, over it or on it is near enough for its noise
        sigma = depth_sigma(float(np.median(depths[on])))
        on &= along[:, 2] < max(half[2], WITHIN_SIGMAS * sigma)
        if on.sum() < LEAST_POINTS:
            continue
        free &= ~on
        normal = box.R[:, 2] * np.sign((eye - box.center) @ box.R[:, 2])
        yield Patch(normal, points[on], depths[on], pixels[on])


def _points(view: View) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.int32]]:
    """Points (N, 3) in the map frame, depths (N,) and flat indexes (N,) of a view's pixels."""
    camera, depth = view.camera, view.depth_m
    assert camera is not None and depth is not None
    v, u = np.nonzero(depth[::THIN, ::THIN] > 0)
    v, u = v * THIN, u * THIN
    z = depth[v, u].astype(np.float64)
    xyz = np.stack([(u - camera.cx) / camera.fx * z, (v - camera.cy) / camera.fy * z, z], axis=1)
    T = view.T_map_camera
    return xyz @ T[:3, :3].T + T[:3, 3], z, (v * depth.shape[1] + u).astype(np.int32)
