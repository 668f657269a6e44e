"""Parts of one body that something parts in the image: joined again where all agrees."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import cv2
import numpy as np
from numpy.typing import NDArray

from afkb_mapping.bodies import Body
from afkb_mapping.from_above import hull_candidates, reach_xy
from afkb_mapping.opening_kernels import border_lines
from afkb_mapping.openings import find_opening
from afkb_mapping.order_statistics import percentile
from afkb_things.rejoin_kernels import merged, pairs_behind, share_on, through
from afkb_things.scene import Scene
from afkb_things.surroundings import named

NEAR_M = 0.03
"""Parts of one hollow lie this near to each other, seen from above."""
LEVEL_M = 0.015
"""Rims of one hollow, and tops of one body, are this level."""
RIM_SHARE, INSIDE_SHARE = 0.6, 0.4
"""Of a hollow that parts make together: how far around the rim is seen, and how much of what is
seen through the rim's plane lies below it; a notch between closed bodies is mostly their tops."""
SIGHT_SHARE = 0.6
"""Or how far below the rim is seen, as a share of what sight lines that pass it could show: from
low above it little of a hollow is seen, but all that could be. In a notch they end early."""
LEAST_BEHIND = 5
"""Pixel pairs in which a part must lie behind what covers its middle."""
OUTLINE_M, OUTLINE_SHARE = 0.010, 0.85
"""So near to the outline of both parts, seen from above, must such a share of their sides lie."""
BELOW_TOP_M = 0.02
SAMPLES, HOLLOW_SAMPLES, HULL_SAMPLES = 2000, 4000, 4000
"""About so many points say how high a top is, whether it is hollow, and what its outline is."""
SEEN_THROUGH = 20
"""Pixels of the support between two parts that show that nothing joins them."""

Hull = tuple[NDArray[np.float64], NDArray[np.float64]]


def rejoined(bodies: Sequence[Body], scene: Scene) -> list[Body]:
    """The bodies, those joined that are one hollow, or one thing behind another, and filled."""
    with named(bodies, scene.names) as names:
        pairs = pairs_behind(scene.depth_m, names, len(bodies), around(bodies), scene.noise)
        taken = names > 0
    kept = [_filled(body, scene, taken) for body in bodies]
    tops = [_top_m(body) for body in bodies]
    for a in range(len(kept)):
        for b in range(a + 1, len(kept)):
            first, second = kept[a], kept[b]
            if first is None or second is None or abs(tops[a] - tops[b]) > _level_m(first, second):
                continue
            if _touch(first, second):
                joined = _hollow(_both(first, second), scene, taken)
            else:
                covered = (pairs[a] >= LEAST_BEHIND) & (pairs[b] >= LEAST_BEHIND)
                joined = _one(first, second, scene) if covered.any() else None
            if joined is not None:
                kept[a], kept[b] = None, joined
                pairs[b] += pairs[a]
                break
    return [body for body in kept if body is not None]


def _both(a: Body, b: Body) -> Body:
    """Two bodies as one, by rows and columns as each of them is."""
    order = merged(a.u, a.v, b.u, b.v)
    u, v = np.concatenate([a.u, b.u]), np.concatenate([a.v, b.v])
    depth = np.concatenate([a.depth_m, b.depth_m])
    points = np.concatenate([a.points, b.points])
    return replace(a, u=u, v=v, depth_m=depth, points=points).part(order)


def _level_m(a: Body, b: Body) -> float:
    """How much the heights of two tops that are one may differ; below 0 on other supports."""
    if a.support_height_m != b.support_height_m:
        return -1.0
    return LEVEL_M + 2.0 * max(a.sigma_m, b.sigma_m)


def around(bodies: Sequence[Body]) -> tuple[int, int, int, int]:
    """The image box around bodies; empty around none."""
    boxes = np.array([body.image_box for body in bodies]).reshape(-1, 4)
    if not len(boxes):
        return 0, 0, 0, 0
    (u0, v0), (u1, v1) = boxes[:, :2].min(axis=0), boxes[:, 2:].max(axis=0)
    return int(u0), int(v0), int(u1), int(v1)


def _top_m(body: Body) -> float:
    return percentile(body.points[:: max(1, len(body.points) // SAMPLES), 2], 98.0)


def _touch(a: Body, b: Body) -> bool:
    """Whether, seen from above, the rectangles around both come near each other."""
    one, other = reach_xy(a.points), reach_xy(b.points)
    return bool((np.maximum(one[0], other[0]) - np.minimum(one[1], other[1]) < NEAR_M).all())


def _hollow(body: Body, scene: Scene, taken: NDArray[np.bool_]) -> Body | None:
    """A body with its inside, or None where it has no opening that all of it is around."""
    full = _with_inside(body, scene, taken)
    return full if is_hollow(full, scene) else None


def is_hollow(body: Body, scene: Scene) -> bool:
    """Whether all of a body is around one opening."""
    thin = max(1, len(body.u) // HOLLOW_SAMPLES)
    seen = body if thin == 1 else body.part(np.arange(0, len(body.u), thin))
    opening = find_opening(seen, scene.camera_xyz)
    if opening is None or opening.rim_share < RIM_SHARE:
        return False
    return opening.inside_share >= INSIDE_SHARE or opening.sight_share >= SIGHT_SHARE


def _filled(body: Body, scene: Scene, taken: NDArray[np.bool_]) -> Body | None:
    """A body with what of its inside was taken for the support, if it is a hollow."""
    if len(_inside(body, scene, taken)[0]) < SEEN_THROUGH:
        return body
    return _hollow(body, scene, taken) or body


def _inside(
    body: Body, scene: Scene, taken: NDArray[np.bool_]
) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    """Pixels of no body that are seen from above within a body's outline, away from its border."""
    return _seen_down(scene, taken, body, _hull(body))


def _seen_down(
    scene: Scene, taken: NDArray[np.bool_], body: Body, hull: Hull
) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    """Pixels that aren't taken, whose sight lines come down through a body's top within a hull."""
    margin, top = OUTLINE_M + 2.0 * body.sigma_m, _top_m(body)
    return through(
        scene.depth_m,
        scene.intrinsics,
        scene.T_map_camera,
        taken,
        body.image_box,
        *hull,
        margin,
        top,
    )


def _with_inside(body: Body, scene: Scene, taken: NDArray[np.bool_]) -> Body:
    u, v = _inside(body, scene, taken)
    if not len(u):
        return body
    depths, points = scene.at(u, v)
    a, b, c = body.slope
    points[:, 2] -= a * points[:, 0] + b * points[:, 1] + c
    return _both(body, replace(body, u=u, v=v, depth_m=depths, points=points))


def _hull(body: Body) -> Hull:
    """Border lines of a body's outline, seen from above."""
    corners = cv2.convexHull(
        hull_candidates(body.points[:: max(1, len(body.points) // HULL_SAMPLES)])
    ).reshape(-1, 2)
    return border_lines(corners.astype(np.float64))


def _one(a: Body, b: Body, scene: Scene) -> Body | None:
    """Two parts as one, if they lie on the outline of one solid, and no support is between."""
    both = _both(a, b)
    hull = _hull(both)
    margin = OUTLINE_M + 2.0 * both.sigma_m
    top = _top_m(both) - BELOW_TOP_M
    if min(share_on(p.points, top, *hull, margin) for p in (a, b)) < OUTLINE_SHARE:
        return None
    u, _ = _seen_down(scene, scene.labels >= 0, both, hull)
    return both if len(u) < SEEN_THROUGH else None
