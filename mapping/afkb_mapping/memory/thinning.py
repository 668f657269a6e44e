"""The part of a view and of its detections that a map is built from; the rest is let go.

Lengths are kept to a millimetre, far below any sensor's noise, so that what is stored and read
again is the same to the bit: a map that is built from it again is the same map.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from afkb.errors import BadFrame
from afkb.flow import Detection, LaserScan, PinholeCamera, View
from afkb_mapping.panorama import pixel_step

MM_PER_M = 1000.0
FARTHEST_MM = 65535
"""What 16 bits hold: 65 m, beyond any depth camera's reach and any indoor laser's use."""

NO_POINTS = np.zeros((0, 2))


def thinned_view(view: View) -> View:
    """A placed view with the pixels that panorama and grid read, and no colour.

    It is a view like any other, of a camera with fewer pixels. Raises `BadFrame` where hardly a
    pixel returned, so that none of those is left, and there is no scan either.
    """
    scan = None if view.scan is None else _thinned_scan(view.scan)
    depth_m = camera = None
    if view.depth_m is not None and view.camera is not None:
        step = pixel_step(view.camera)
        depth_m = metres(millimetres(view.depth_m[::step, ::step]))
        camera = _thinned_camera(view.camera, step)
        if not depth_m.any():
            depth_m = camera = None
    if depth_m is None and scan is None:
        raise BadFrame("hardly a pixel of the depth image returned")
    return replace(view, depth_m=depth_m, camera=camera, color=None, scan=scan)


def millimetres(lengths_m: NDArray[np.float32]) -> NDArray[np.uint16]:
    """Lengths, m, as whole millimetres; 0 for what is not finite or lies beyond `FARTHEST_MM`."""
    mm = np.round(lengths_m * np.float32(MM_PER_M))
    with np.errstate(invalid="ignore"):
        fits = (mm > 0) & (mm <= FARTHEST_MM)
    return np.where(fits, mm, 0).astype(np.uint16)


def metres(lengths_mm: NDArray[np.uint16]) -> NDArray[np.float32]:
    """The inverse of `millimetres`."""
    return (lengths_mm / MM_PER_M).astype(np.float32)


def ranges_of(lengths_mm: NDArray[np.uint16]) -> NDArray[np.float32]:
    """Ranges of a scan, m; NaN where no beam came back."""
    ranges_m = metres(lengths_mm)
    ranges_m[lengths_mm == 0] = np.nan
    return ranges_m


def thinned_detection(detection: Detection) -> Detection:
    """A detection without its pixels and shapes, which only detectors and predictors need.

    Of its parts only who made them and what they said they afford is left.
    """
    parts = tuple(_without_points(part, ()) for part in detection.parts)
    footprint = np.round(detection.footprint_xy * MM_PER_M) / MM_PER_M
    return replace(_without_points(detection, parts), footprint_xy=footprint)


def _without_points(detection: Detection, parts: tuple[Detection, ...]) -> Detection:
    return replace(
        detection,
        footprint_xy=NO_POINTS,
        about=None,
        pixels=None,
        rings_xy=(),
        border={},
        primitive=None,
        parts=parts,
    )


def _thinned_scan(scan: LaserScan) -> LaserScan:
    return replace(scan, ranges_m=ranges_of(millimetres(np.where(scan.hit, scan.ranges_m, 0))))


def _thinned_camera(camera: PinholeCamera, step: int) -> PinholeCamera:
    return PinholeCamera(
        -(-camera.width // step),
        -(-camera.height // step),
        camera.fx / step,
        camera.fy / step,
        camera.cx / step,
        camera.cy / step,
    )
