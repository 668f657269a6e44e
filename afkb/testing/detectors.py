"""The contract of a detector."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from afkb.flow import Detection, View
from afkb.knowledge import AfNet
from afkb.plugins.protocols import Detector
from afkb.testing.require import require, require_known, require_name, same

_FARTHEST_M = 100.0


def check_detector(
    detector: Detector,
    views: Sequence[View],
    knowledge_base: AfNet | None = None,
    earlier: Sequence[Detector] = (),
) -> None:
    """Raise unless the detector keeps its contract on these placed views.

    `earlier`: detectors of lower stages whose findings it is handed, in order. It must also bear
    a view without depth and one without a laser scan, as recordings that lack them need.
    """
    name = require_name(detector, f"detector {type(detector).__name__}")
    who = f"detector {name!r}"
    require(isinstance(detector, Detector), who, "is no Detector", "see afkb.plugins.protocols")
    listed = isinstance(detector.affordances, tuple) and len(detector.affordances) > 0
    require(listed, who, "affordances is not a filled tuple", "name the features it can report")
    staged = isinstance(detector.stage, int) and detector.stage >= 0
    require(staged, who, f"stage is {detector.stage!r}", "0 for what stands by itself, else 1")
    if knowledge_base is not None:
        require_known(detector.affordances, knowledge_base.features, who, "affordances")
    for view in views:
        for variant in _variants(view):
            _check_on(detector, variant, _seen_earlier(earlier, variant), who)


def _variants(view: View) -> list[View]:
    """The view, and where it has both sensors the view of each alone."""
    if view.depth_m is None or view.scan is None:
        return [view]
    no_scan = replace(view, scan=None, T_base_laser=None)
    no_depth = replace(view, depth_m=None, camera=None, T_base_camera=None, color=None)
    return [view, no_scan, no_depth]


def _seen_earlier(detectors: Sequence[Detector], view: View) -> list[Detection]:
    seen: list[Detection] = []
    for detector in detectors:
        seen += detector.detect(view, tuple(seen))
    return seen


def _check_on(detector: Detector, view: View, earlier: Sequence[Detection], who: str) -> None:
    untouched = None if view.depth_m is None else view.depth_m.copy()
    found = list(detector.detect(view, tuple(earlier)))
    again = list(detector.detect(view, tuple(earlier)))
    where = f"{who} on view {view.index}"
    require(same(found, again), where, "finds other things the second time", "seed its randomness")
    require(same(untouched, view.depth_m), where, "changes the depth image", "work on a copy")
    check_detections(found, view, where)
    for d in found:
        require(
            d.detector == detector.name, where, f"signs as {d.detector!r}", "sign with its name"
        )
        told = d.about is None or 0 <= d.about < len(earlier)
        require(told, where, f"is about detection {d.about} of {len(earlier)}", "index `earlier`")
        undeclared = sorted(set(d.affordances) - set(detector.affordances))
        require(not undeclared, where, f"reports undeclared {undeclared}", "add to `affordances`")


def check_detections(detections: Sequence[Detection], view: View, who: str = "detections") -> None:
    """Raise unless each detection is finite, in metres, and where that view could see it."""
    for d in detections:
        require(isinstance(d, Detection), who, f"returns {type(d).__name__}", "return Detections")
        _check_shape(d, who)
        _check_place(d, view, who)


def _check_shape(d: Detection, who: str) -> None:
    box = np.array([*d.box.center_xyz, *d.box.size_xyz, d.box.yaw])
    finite = bool(np.isfinite(box).all()) and min(d.box.size_xyz) >= 0
    require(finite, who, f"box {d.box} is not finite or has a negative size", "drop or mend it")
    cov = d.covariance_xyz
    symmetric = cov.shape == (3, 3) and bool(np.isfinite(cov).all()) and np.allclose(cov, cov.T)
    require(symmetric, who, "covariance_xyz is no finite symmetric (3, 3)", "give m²")
    least = float(np.linalg.eigvalsh(cov)[0])
    require(least > -1e-12, who, f"covariance_xyz has eigenvalue {least:.1e}", "make it a variance")
    feet = d.footprint_xy
    flat = feet.ndim == 2 and feet.shape[1] == 2 and len(feet) > 0 and bool(np.isfinite(feet).all())
    require(flat, who, f"footprint_xy has shape {feet.shape}", "give finite (N, 2) points, N > 0")
    if d.segment_xy is not None:
        ends = d.segment_xy.shape == (2, 2) and bool(np.isfinite(d.segment_xy).all())
        require(
            ends, who, "segment_xy is no finite (2, 2)", "give both end points in the map frame"
        )
    require(d.n_pixels > 0, who, f"n_pixels is {d.n_pixels}", "count the pixels or beams behind it")
    whole = not d.border or abs(sum(d.border.values()) - 1) < 1e-6
    require(whole, who, f"border {dict(d.border)} does not sum to 1", "give shares of the outline")
    rings = all(r.ndim == 2 and r.shape[1] == 2 and len(r) >= 3 for r in d.rings_xy)
    require(rings, who, "rings_xy holds what is no ring", "give (N, 2) points, N >= 3")


def _check_place(d: Detection, view: View, who: str) -> None:
    near = 0 < d.range_m < _FARTHEST_M
    require(near, who, f"range_m is {d.range_m}", "give the distance from the sensor in metres")
    if view.T_map_base is not None:
        away = float(np.linalg.norm(d.position_xyz - view.T_map_base[:3, 3]))
        sane = away < d.range_m + _FARTHEST_M
        require(sane, who, f"position is {away:.0f} m away", "give it in the map frame, in metres")
    if d.image_box is not None and view.camera is not None:
        u0, v0, u1, v1 = d.image_box
        inside = 0 <= u0 < u1 <= view.camera.width and 0 <= v0 < v1 <= view.camera.height
        require(inside, who, f"image_box {d.image_box} leaves the image", "clip it, half-open")
    if d.pixels is not None and view.depth_m is not None:
        flat = d.pixels.ndim == 1 and d.pixels.dtype == np.int32 and len(d.pixels) > 0
        require(flat, who, "pixels is no filled (n,) int32", "give v * width + u of each pixel")
        held = bool((d.pixels >= 0).all() and (d.pixels < view.depth_m.size).all())
        require(held, who, "pixels leave the image", "give v * width + u of each pixel")
