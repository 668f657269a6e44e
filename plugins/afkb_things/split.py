"""What stands together, seen from above, told apart where surfaces meet in valleys."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.bodies import Body
from afkb_mapping.image_regions import order_by_label
from afkb_things.cells import cell_box, cell_size, cells_of, of_pixels
from afkb_things.parts import BEHIND, TOUCH, Parts, measures_of
from afkb_things.patches import contacts, patches_of
from afkb_things.rejoin import is_hollow
from afkb_things.scene import Scene
from afkb_things.surroundings import named
from afkb_things.valleys import valleys

MOST_PATCHES = 60
"""More patches in one pool are noise that no edge can be told from."""


def split(bodies: Sequence[Body], scene: Scene, min_pixels: int) -> list[Body]:
    """The bodies that make up groups of what stands together, none of whose pixels they share."""
    parts: list[Body] = []
    with named(bodies, scene.names) as pools:
        for name, body in enumerate(bodies, start=1):
            if len(body.u) < 2 * min_pixels:
                parts.append(body)
            else:
                parts += _split(body, scene, pools, name, min_pixels)
    return parts


def _split(
    body: Body,
    scene: Scene,
    pools: NDArray[np.int32],
    name: int,
    min_pixels: int,
) -> Iterator[Body]:
    """The bodies that make up one group, whose pixels are marked with its name in `pools`."""
    focal, noise = float(scene.intrinsics[0]), scene.noise
    size = cell_size(focal, body.range_m)
    box = cell_box(body.image_box, scene.depth_m.shape, size)
    depth, kind = cells_of(scene.depth_m, pools, name, scene.labels, size, box, noise)
    valley = valleys(depth, focal / size, noise)
    patches, count = patches_of(depth, kind, valley, noise)
    if not 1 < count <= MOST_PATCHES:
        yield body
        return
    meet = contacts(depth, patches, valley, count, noise, box[0])
    own = of_pixels(body.u, body.v, body.depth_m, depth, patches, size, box, noise)
    measures = measures_of(own, body.u, body.depth_m, body.points, count, noise)
    yield from _bodies(body, own, Parts(measures, meet, body.base_m, min_pixels, size), scene)


def _bodies(body: Body, own: NDArray[np.int32], parts: Parts, scene: Scene) -> Iterator[Body]:
    """The bodies that a group is made of; the group itself where it is one."""
    parts.join_smooth()
    parts.join_small()
    parts.join_floating()
    if len(parts.kept) > 1 and is_hollow(body, scene):
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
        yield body.part(order[starts[k] : starts[k + 1]])


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
            both = body.part(np.flatnonzero((of == a) | (of == b)))
            if is_hollow(both, scene):
                return a, b
    return None
