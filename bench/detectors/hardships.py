"""What can befall a depth image: pixels lost, noise, other sizes, a tilted camera, glass."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import cv2
import numpy as np
from numpy.typing import NDArray

from afkb.flow import PinholeCamera, View
from afkb_mapping.sensor_noise import depth_sigma

Depth = NDArray[np.float32]
PANE, BEHIND_M = 0.3, 4.5
"""A pane of glass takes this share of the image's width; half of it returns nothing, the other half
a wall this far behind it."""


@dataclass(frozen=True)
class Hardship:
    """One value on one axis, and what it does to a view."""

    axis: str
    value: float
    label: str
    befall: Callable[[View, np.random.Generator], View]


def hardships() -> list[Hardship]:
    """Every value that is tried; each axis begins with what the recording is like itself."""
    return [
        *(Hardship("missing", s, f"{s:.0%} missing", _losing(s)) for s in (0.0, 0.25, 0.5, 0.75)),
        *(Hardship("noise", f, f"noise x{f:g}", _noisy(f)) for f in (1.0, 2.0, 3.0, 5.0)),
        *(Hardship("roll", d, f"rolled {d:g}°", _rolled(d)) for d in (0.0, 15.0, 30.0, 45.0)),
        Hardship("width", 320, "320x240", _halved),
        Hardship("width", 640, "640x480", _same),
        Hardship("width", 1280, "1280x720", _doubled),
        *(Hardship("range", m, f"0.3 to {m:g} m", _within(0.3, m)) for m in (2.0, 4.0, 8.0)),
        Hardship("glass", 0, "no glass", _same),
        Hardship("glass", 1, "a pane of glass", _glazed),
    ]


def _with(view: View, depth: Depth, camera: PinholeCamera | None = None) -> View:
    # A view without a single return is no view; one pixel keeps it one.
    if not depth.any():
        depth[0, 0] = 1.0
    return replace(view, depth_m=np.ascontiguousarray(depth), camera=camera or view.camera)


def _same(view: View, rng: np.random.Generator) -> View:
    return view


def _losing(share: float) -> Callable[[View, np.random.Generator], View]:
    def befall(view: View, rng: np.random.Generator) -> View:
        depth = _depth(view).copy()
        depth[rng.random(depth.shape) < share] = 0
        return _with(view, depth)

    return befall


def _noisy(factor: float) -> Callable[[View, np.random.Generator], View]:
    """Noise of `factor` times the sensor's own: what it has already counts."""
    sigma_of = np.vectorize(depth_sigma, otypes=[np.float32])

    def befall(view: View, rng: np.random.Generator) -> View:
        depth = _depth(view)
        steps = sigma_of(np.arange(0, 2000) / 100.0)
        sigma = steps[np.minimum(100 * depth, 1999).astype(int)] * np.sqrt(factor**2 - 1)
        more = sigma * rng.standard_normal(depth.shape, dtype=np.float32)
        return _with(view, np.where(depth > 0, np.maximum(depth + more, 0.05), 0).astype("f4"))

    return befall


def _rolled(degrees: float) -> Callable[[View, np.random.Generator], View]:
    """The camera turned about its optical axis; what comes into view at the corners is missing."""
    a = np.radians(degrees)
    T = np.eye(4)
    T[:2, :2] = [[np.cos(a), -np.sin(a)], [np.sin(a), np.cos(a)]]

    def befall(view: View, rng: np.random.Generator) -> View:
        camera = view.camera
        assert camera is not None and view.T_base_camera is not None
        K = camera.matrix
        turn = (K @ T[:3, :3] @ np.linalg.inv(K))[:2]
        size = (camera.width, camera.height)
        flags = cv2.INTER_NEAREST | cv2.WARP_INVERSE_MAP
        depth = np.asarray(cv2.warpAffine(_depth(view), turn, size, flags=flags), np.float32)
        return replace(_with(view, depth), T_base_camera=view.T_base_camera @ T)

    return befall


def _halved(view: View, rng: np.random.Generator) -> View:
    return _with(view, _depth(view)[::2, ::2], _scaled(view, 0.5))


def _doubled(view: View, rng: np.random.Generator) -> View:
    """Twice as many pixels, each of them twice; the middle 3/4 of the rows, as of a wide image."""
    depth = np.repeat(np.repeat(_depth(view), 2, axis=0), 2, axis=1)
    camera = _scaled(view, 2.0)
    cut = camera.height // 8
    wide = replace(camera, height=camera.height - 2 * cut, cy=camera.cy - cut)
    return _with(view, depth[cut : camera.height - cut], wide)


def _scaled(view: View, by: float) -> PinholeCamera:
    """Its pixels' centres move by half a pixel as they grow; halving takes every second one."""
    c = view.camera
    assert c is not None
    shift = (by - 1) / 2 if by > 1 else 0.0
    return PinholeCamera(
        int(c.width * by), int(c.height * by), c.fx * by, c.fy * by, c.cx * by + shift,
        c.cy * by + shift,
    )  # fmt: skip


def _within(near: float, far: float) -> Callable[[View, np.random.Generator], View]:
    def befall(view: View, rng: np.random.Generator) -> View:
        depth = _depth(view)
        return _with(view, np.where((depth >= near) & (depth <= far), depth, 0).astype(np.float32))

    return befall


def _glazed(view: View, rng: np.random.Generator) -> View:
    depth = _depth(view).copy()
    wide = int(PANE * depth.shape[1])
    left = int(rng.integers(0, depth.shape[1] - wide))
    middle = left + wide // 2
    depth[:, left:middle] = 0
    behind = depth[:, middle : left + wide]
    behind[:] = BEHIND_M + depth_sigma(BEHIND_M) * rng.standard_normal(behind.shape)
    return _with(view, depth)


def _depth(view: View) -> Depth:
    assert view.depth_m is not None
    return view.depth_m
