"""Surfaces beside their peers: CPU time a frame on one core, and how many true tops they match.

Ours with borders to the pixel and with those of cells, Open3D's planar patches (the plugin
`open3d-patches`), and Open3D's RANSAC, plane after plane; all on the same frames in one run. Tops
matched, not planes, are counted: a method that cuts a table in four finds one table.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from afkb.flow import View
from afkb.plugins.protocols import Detector
from afkb_mapping.from_above import on_grid
from afkb_surfaces.detector import SurfaceDetector
from bench.detectors.data import Asked, Home
from bench.detectors.seen import CLAIMED, inside
from bench.detectors.surfaces import HEIGHT_TOLERANCE_M, tops_of

NEEDS = ("homes",)
FRAMES = 40
"""Of each home, spread evenly: the peers take long."""
WARM_UP = 3
THIN, PLANES, WITHIN_M, ITERATIONS, LEAST_POINTS = 4, 6, 0.02, 200, 200
LEVEL_COS = np.cos(np.radians(30))

Top = tuple[float, NDArray[np.float64]]
"""Height and footprint (N, 2) of what a method takes for a support, m."""


def run(asked: Asked) -> dict[str, Any]:
    """Of each home, by method: CPU ms a frame, and the tops matched in all frames and at all."""
    methods = _methods(asked)
    with _one_core():
        return {h.name: {n: _measured(m, h) for n, m in methods.items()} for h in asked.homes}


def table(result: dict[str, Any]) -> Iterator[str]:
    for home, methods in result.items():
        first = next(iter(methods.values()))
        yield (
            f"{home}: {first['frames']} frames, {first['tops']} tops seen well; CPU ms a frame on "
            "one core, tops matched"
        )
        for name, m in methods.items():
            yield (
                f"  {name:24} median {m['median']:6.1f}  95 % {m['p95']:6.1f}  tenth frame "
                f"{m['tenth']:6.1f}  matched {m['found']:3d}, frame by frame {m['matched']:4d}"
            )


def _methods(asked: Asked) -> dict[str, Callable[[View], list[Top]]]:
    ours = _ours(asked)
    coarse = SurfaceDetector(replace(ours.settings, borders=False))
    (peer,) = asked.host.detectors(["open3d-patches"])
    return {
        "surfaces, pixel borders": _tops_of(ours),
        "surfaces, cell borders": _tops_of(coarse),
        "Open3D planar patches": _tops_of(peer),
        "Open3D RANSAC": _ransac_tops,
    }


def _ours(asked: Asked) -> SurfaceDetector:
    """Our detector with the ontology's limits, without what calibrates it."""
    (found,) = asked.host.detectors(["surfaces"])
    inner = getattr(found, "scorer", found)
    assert isinstance(inner, SurfaceDetector)
    return inner


def _tops_of(detector: Detector) -> Callable[[View], list[Top]]:
    def tops(view: View) -> list[Top]:
        return [
            (float(d.position_xyz[2]), d.footprint_xy)
            for d in detector.detect(view, ())
            if d.affords("SupportAbility", CLAIMED) and not d.measures.get("is_floor")
        ]

    return tops


def _ransac_tops(view: View) -> list[Top]:
    """Level planes among the largest that RANSAC finds, one after the other."""
    import open3d as o3d

    camera, depth = view.camera, view.depth_m
    assert camera is not None and depth is not None
    v, u = np.nonzero(depth[::THIN, ::THIN] > 0)
    z = depth[v * THIN, u * THIN].astype(np.float64)
    x, y = (u * THIN - camera.cx) / camera.fx * z, (v * THIN - camera.cy) / camera.fy * z
    T = view.T_map_camera
    points = np.stack([x, y, z], axis=1) @ T[:3, :3].T + T[:3, 3]
    tops = []
    for _ in range(PLANES):
        if len(points) < LEAST_POINTS:
            break
        cloud = o3d.geometry.PointCloud(o3d.utility.Vector3dVector(points))
        plane, inliers = cloud.segment_plane(WITHIN_M, 3, ITERATIONS)
        on = points[inliers]
        height = float(np.median(on[:, 2]))
        if len(on) >= LEAST_POINTS and abs(plane[2]) > LEVEL_COS and height > WITHIN_M:
            tops.append((height, on_grid(on, 0.02 * THIN)))
        points = np.delete(points, inliers, axis=0)
    return tops


def _measured(method: Callable[[View], list[Top]], home: Home) -> dict[str, Any]:
    views = list(home.views())
    views = views[:: max(1, len(views) // FRAMES)]
    things = tops_of(home.truth)
    for view in views[:WARM_UP]:
        method(view)
    taken, matched, found = [], 0, set()
    for view in views:
        start = time.process_time()
        tops = method(view)
        taken.append(1e3 * (time.process_time() - start))
        names = {t["name"] for t in things if _matches(t, tops)}
        matched += len(names)
        found |= names
    return {
        "frames": len(views),
        "tops": len(things),
        "median": float(np.median(taken)),
        "p95": float(np.percentile(taken, 95)),
        "tenth": float(taken[min(9, len(taken) - 1)]),
        "matched": matched,
        "found": len(found),
    }


def _matches(thing: dict[str, Any], tops: Sequence[Top]) -> bool:
    """Whether one of the tops lies at a thing's, most of it within the thing's box."""
    return any(
        abs(height - thing["top_height"]) <= HEIGHT_TOLERANCE_M
        and len(xy) > 0
        and inside(thing, xy).mean() > 0.5
        for height, xy in tops
    )


@contextmanager
def _one_core() -> Iterator[None]:
    """Keep this process, with every thread that a library starts, on one core."""
    if not hasattr(os, "sched_setaffinity"):
        yield
        return
    before = os.sched_getaffinity(0)
    os.sched_setaffinity(0, {min(before)})
    try:
        yield
    finally:
        os.sched_setaffinity(0, before)
