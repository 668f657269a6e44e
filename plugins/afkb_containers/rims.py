"""Surfaces of one height that may be parts of one rim: of a tub, one sees its sides apart."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from afkb.flow import Detection
from afkb_mapping.from_above import on_grid
from afkb_mapping.image_regions import Rectangle

CELL_M = 0.02
SAME_HEIGHT_M = 0.015
WIDEST_M = 0.8
"""Sides of one rim lie no further apart: as far as those of a bath tub."""


@dataclass(frozen=True, slots=True, eq=False)
class Rim:
    """Supports of one height, near each other: squares (N, 2) of CELL_M, and where in the image."""

    height_m: float
    footprint_xy: NDArray[np.float64]
    image_box: Rectangle | None
    range_m: float
    cut_by_image: bool

    @property
    def area_m2(self) -> float:
        """How much of it is seen, from above."""
        return len(self.footprint_xy) * CELL_M**2


def rims_among(supports: Sequence[Detection]) -> list[Rim]:
    """Each support with those near it at its height, told of once."""
    groups: list[list[Detection]] = []
    for support in sorted(supports, key=lambda d: -d.n_pixels):
        near = (g for g in groups if any(_one_rim(support, other) for other in g))
        group = next(near, None)
        if group is None:
            groups.append([support])
        else:
            group.append(support)
    return [_joined(group) for group in groups]


def _one_rim(a: Detection, b: Detection) -> bool:
    """Whether they may meet beyond the image's edge, as the sides of a tub do."""
    if not (a.cut_by_image and b.cut_by_image):
        return False
    if abs(float(a.position_xyz[2] - b.position_xyz[2])) > SAME_HEIGHT_M:
        return False
    low = np.maximum(a.footprint_xy.min(axis=0), b.footprint_xy.min(axis=0))
    high = np.minimum(a.footprint_xy.max(axis=0), b.footprint_xy.max(axis=0))
    return bool(np.hypot(*np.maximum(low - high, 0.0)) <= WIDEST_M)


def _joined(group: Sequence[Detection]) -> Rim:
    n_pixels = max(sum(d.n_pixels for d in group), 1)
    boxes = [d.image_box for d in group if d.image_box is not None]
    footprint = group[0].footprint_xy
    if len(group) > 1:
        footprint = np.vstack([d.footprint_xy for d in group])
    return Rim(
        height_m=sum(float(d.position_xyz[2]) * d.n_pixels for d in group) / n_pixels,
        footprint_xy=on_grid(footprint, CELL_M),
        image_box=_around(boxes) if len(boxes) == len(group) else None,
        range_m=min(d.range_m for d in group),
        cut_by_image=any(d.cut_by_image for d in group),
    )


def _around(boxes: Sequence[Rectangle]) -> Rectangle:
    """The smallest box of pixels around others."""
    u0, v0, u1, v1 = zip(*boxes, strict=True)
    return min(u0), min(v0), max(u1), max(v1)
