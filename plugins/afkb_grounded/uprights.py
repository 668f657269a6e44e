"""Parts of upright planes: what stands out of them, is set in, or returns no depth.

Handles, switches, hooks, screens, closed doors, drawer fronts: found as regions of an upright
plane's relief that the plane bounds. What they are, or afford, is not asked here.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from afkb.flow import Detection, OrientedBox, View
from afkb_grounded.relief_kernel import (
    FLAT,
    UNKNOWN,
    part_sums,
    relief_of,
    ring_flat_share,
)
from afkb_grounded.seen import PART, UPRIGHT, Seen
from afkb_mapping.depth_points import intrinsics_of
from afkb_mapping.grid.components import AREA, HEIGHT, LEFT, TOP, WIDTH, components
from afkb_mapping.sensor_noise import depth_sigma

FARTHEST_M = 2.5
"""Beyond this a relief is noise: depth strays by a centimetre, and steps by more."""
MOST_UPRIGHTS, MOST_PARTS = 3, 12
LEAST_CELL_M = 0.012
PIXELS_PER_CELL = 4
LEAST_CELLS = 4
BOUNDED = 0.55
"""Share of a part's surroundings in which the plane must go on: what stands before a wall is
bounded by the floor or by other furniture."""
LEAST_PIXELS = 400
MOST_CELLS = 60_000


def parts_of(things: Sequence[Seen], view: View) -> Iterator[Seen]:
    """Parts of the largest uprights near by, as things of their own that nobody told of yet."""
    if view.depth_m is None or view.camera is None:
        return
    near = [
        thing
        for thing in things
        if UPRIGHT in thing.kinds
        and thing.first.image_box is not None
        and thing.first.range_m < FARTHEST_M
        and thing.first.n_pixels >= LEAST_PIXELS
    ]
    near.sort(key=lambda thing: (-thing.first.n_pixels, thing.index))
    for thing in near[:MOST_UPRIGHTS]:
        yield from _parts(thing.first, view)


def _parts(upright: Detection, view: View) -> Iterator[Seen]:
    assert upright.segment_xy is not None and upright.image_box is not None
    assert view.depth_m is not None and view.camera is not None
    start, end = upright.segment_xy
    length = float(np.linalg.norm(end - start))
    cell = max(LEAST_CELL_M, PIXELS_PER_CELL * upright.range_m / view.camera.fx)
    shape = (int(length / cell), int(upright.box.size_xyz[2] / cell))
    if min(shape) < 3 or shape[0] * shape[1] > MOST_CELLS:
        return
    along = (end - start) / length
    bottom = upright.box.bottom
    kinds, offsets, lost = relief_of(
        view.depth_m, intrinsics_of(view), view.T_map_camera,
        np.array(upright.image_box, np.int64), start, along, bottom, shape, cell,
    )  # fmt: skip
    own = ((kinds != FLAT) & (kinds != UNKNOWN)).astype(np.uint8)
    labels, measures = components(own, False)
    sums = part_sums(labels, kinds, offsets, lost, len(measures))
    by_size = sorted(range(1, len(measures)), key=lambda k: -int(measures[k, AREA]))
    for k in by_size[:MOST_PARTS]:
        row = measures[k]
        if row[AREA] < LEAST_CELLS or _bounded(kinds, labels, k, row) < BOUNDED:
            continue
        yield _part(upright, start, along, bottom, cell, row, sums[k], view)


def _bounded(
    kinds: NDArray[np.uint8], labels: NDArray[np.int32], k: int, row: NDArray[np.int32]
) -> float:
    i0, j0 = int(row[TOP]), int(row[LEFT])
    i1, j1 = i0 + int(row[HEIGHT]), j0 + int(row[WIDTH])
    return ring_flat_share(kinds, labels, k, i0, j0, i1, j1)


def _part(
    upright: Detection,
    start: NDArray[np.float64],
    along: NDArray[np.float64],
    bottom: float,
    cell: float,
    row: NDArray[np.int32],
    sums: NDArray[np.float64],
    view: View,
) -> Seen:
    assert view.camera is not None
    cells, seen, offset_sum, square_sum, lost_sum = (float(s) for s in sums)
    offset = offset_sum / seen if seen else 0.0
    spread = max(square_sum / seen - offset**2, 0.0) ** 0.5 if seen else 0.0
    length, height = float(row[HEIGHT]) * cell, float(row[WIDTH]) * cell
    low = bottom + float(row[LEFT]) * cell
    middle = start + along * (float(row[TOP]) * cell + length / 2)
    thick = max(abs(offset), LEAST_CELL_M)
    longer, shorter = max(length, height), min(length, height)
    measures = {
        "normal_to_up_deg": 90.0,
        "length_m": length,
        "width_m": thick,
        "height_m": height,
        "top_height_m": low + height,
        "bottom_height_m": max(low, 0.0),
        "max_extent_m": longer,
        "middle_extent_m": max(shorter, min(thick, longer)),
        "min_extent_m": min(thick, shorter),
        "area_m2": cells * cell**2,
        "elongation": longer / shorter,
        "aspect": longer / shorter,
        "thickness_over_extent": min(thick, shorter) / longer,
        "planarity_rms_over_extent": spread / longer,
        "rectangle_fill": cells / float(row[HEIGHT] * row[WIDTH]),
        "protrusion_m": offset,
        "missing_depth_share": lost_sum / cells,
    }
    yaw = float(np.arctan2(along[1], along[0]))
    box = OrientedBox((float(middle[0]), float(middle[1]), low + height / 2),
                      (length, thick, height), yaw)  # fmt: skip
    spread_m = depth_sigma(upright.range_m) ** 2 + cell**2
    steps = np.linspace(-length / 2, length / 2, max(int(length / 0.02), 2))
    first = Detection(
        detector=upright.detector,
        affordances=upright.affordances,
        box=box,
        position_xyz=np.array(box.center_xyz),
        covariance_xyz=np.diag([spread_m] * 3),
        footprint_xy=middle + steps[:, None] * along,
        n_pixels=max(int(cells * (cell * view.camera.fx / upright.range_m) ** 2), 1),
        range_m=upright.range_m,
        image_box=_image_box(box, along, view),
    )
    return Seen(None, first, (PART,), {}, measures)


def _image_box(
    box: OrientedBox, along: NDArray[np.float64], view: View
) -> tuple[int, int, int, int]:
    """Half-open box round its face in the image, within the image."""
    assert view.camera is not None
    camera = view.camera
    T_camera_map = np.linalg.inv(view.T_map_camera)
    ends = np.array(box.center_xyz[:2]) + np.outer((-0.5, 0.5), along) * box.size_xyz[0]
    corners = np.array([(*end, z) for end in ends for z in (box.bottom, box.top)])
    x, y, z = (corners @ T_camera_map[:3, :3].T + T_camera_map[:3, 3]).T
    z = np.maximum(z, 1e-3)
    u = np.clip(camera.fx * x / z + camera.cx, 0, camera.width - 1)
    v = np.clip(camera.fy * y / z + camera.cy, 0, camera.height - 1)
    return int(u.min()), int(v.min()), int(u.max()) + 1, int(v.max()) + 1
