"""What stands together, seen from above, told apart where surfaces meet in valleys."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.bodies import Body
from afkb_mapping.image_regions import extent, order_by_label
from afkb_mapping.openings import find_opening
from afkb_things.cells import cell_size, cells_of, of_pixels
from afkb_things.parts import BEHIND, TOUCH, Parts, measures_of
from afkb_things.patches import contacts, patches_of
from afkb_things.rejoin import INSIDE_SHARE, RIM_SHARE, around
from afkb_things.scene import Scene
from afkb_things.surroundings import mark
from afkb_things.valleys import valleys

MOST_PATCHES = 60
"""More patches in one pool are noise that no edge can be told from."""


def split(
    bodies: Sequence[Body], scene: Scene, kinds: NDArray[np.int16], min_pixels: int
) -> Iterator[Body]:
    """The bodies that make up groups of what stands together; `kinds` (H, W) are parted, too."""
    if not bodies:
        return
    pools = np.zeros(scene.depth_m.shape, np.int32)
    for name, body in enumerate(bodies, start=1):
        mark(body.u, body.v, pools, name)
    focal = float(scene.intrinsics[0])
    size = cell_size(focal)
    depth, of, kind = cells_of(scene.depth_m, pools, kinds, size, around(bodies))
    valley = valleys(depth, of, focal / size)
    patches = np.zeros(depth.shape, np.int32)
    for name, body in enumerate(bodies, start=1):
        if len(body.u) < 2 * min_pixels:
            yield body
            continue
        u0, v0, u1, v1 = extent(body.u, body.v)
        box = (u0 // size, v0 // size, -(-u1 // size), -(-v1 // size))
        box = (*box[:2], min(box[2], depth.shape[1]), min(box[3], depth.shape[0]))
        count = patches_of(depth, of, name, kind, valley, box, patches)
        if not 1 < count <= MOST_PATCHES:
            yield body
            continue
        meet = contacts(depth, of, name, patches, valley, count, box)
        own = of_pixels(body.u, body.v, body.depth_m, name, of, depth, patches, size)
        measures = measures_of(own, body.u, body.depth_m, body.points, count)
        yield from _bodies(body, own, Parts(measures, meet, body.base_m, min_pixels, size), scene)


def _bodies(body: Body, own: NDArray[np.int32], parts: Parts, scene: Scene) -> Iterator[Body]:
    """The bodies that a group is made of; the group itself where it is one."""
    parts.join_smooth()
    parts.join_small()
    parts.join_floating()
    if len(parts.kept) > 1 and _is_hollow(body, scene):
        yield body
        return
    while len(parts.kept) > 1:
        found = _hollow_pair(body, own, parts, scene)
        if found is None:
            break
        parts.join(*found)
    if len(parts.kept) <= 1:
        yield body
        return
    order, starts = order_by_label(parts.became[own], np.ones(len(parts.became), np.bool_))
    for k in parts.kept:
        yield _part(body, order[starts[k] : starts[k + 1]])


def _hollow_pair(
    body: Body, own: NDArray[np.int32], parts: Parts, scene: Scene
) -> tuple[int, int] | None:
    """Two parts that make a hollow only together: the front of a cup and its inside behind."""
    met = parts.meet[..., TOUCH] + parts.meet[..., BEHIND]
    of = parts.became[own]
    for a in parts.kept:
        for b in parts.kept:
            if a >= b or met[a, b] + met[b, a] == 0:
                continue
            both = _part(body, np.flatnonzero((of == a) | (of == b)))
            if _is_hollow(both, scene):
                return a, b
    return None


def _is_hollow(body: Body, scene: Scene) -> bool:
    opening = find_opening(body, scene.camera_xyz)
    if opening is None:
        return False
    return opening.rim_share >= RIM_SHARE and opening.inside_share >= INSIDE_SHARE


def _part(body: Body, index: NDArray[np.int64]) -> Body:
    return replace(
        body,
        u=body.u[index],
        v=body.v[index],
        depth_m=body.depth_m[index],
        points=body.points[index],
    )
