"""What a view shows of upright surface, by sensor."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from afkb.flow import View
from afkb_mapping.placing.depth_surface import depth_surface_of
from afkb_mapping.placing.odometry import IMAGE_FLOOR, SCAN_FLOOR
from afkb_mapping.placing.scan_surface import SurfacePoints, no_surface, surface_of

Array = NDArray[np.float64]

MIN_POINTS = 20
"""A sensor that shows fewer surface points fixes no pose: it is blind here."""


@dataclass(frozen=True, slots=True, eq=False)
class ViewSurface:
    """What the laser met, and what the camera saw standing upright, in the map frame."""

    scan: SurfacePoints
    image: SurfacePoints

    def moved(self, R: Array, t: Array) -> ViewSurface:
        """The same rotated by R (2, 2), then shifted by t (2,)."""
        return ViewSurface(self.scan.moved(R, t), self.image.moved(R, t))

    @property
    def by_laser(self) -> bool:
        """Whether the laser tells where the view was taken; else the camera does, if anything."""
        return len(self.scan) >= MIN_POINTS

    @property
    def surest(self) -> SurfacePoints:
        """What fixes the pose: the laser's, which is exact and sees far around, or the camera's."""
        return self.scan if self.by_laser else self.image

    @property
    def is_blind(self) -> bool:
        """Whether too little was seen to fix a pose."""
        return len(self.surest) < MIN_POINTS

    @property
    def odometry_floor(self) -> tuple[float, float, float]:
        """What odometry may be off (m, m, rad) from where it was taken however little one moved."""
        return SCAN_FLOOR if self.by_laser else IMAGE_FLOOR


def surface_in_map(view: View, T_map_base: Array) -> ViewSurface:
    """What a view shows, were its level base there (4, 4)."""
    return ViewSurface(_scan_in_map(view, T_map_base), depth_surface_of(view, T_map_base))


def surest_in_map(view: View, T_map_base: Array) -> tuple[SurfacePoints, bool]:
    """`surest` of what a view shows, and whether that is `by_laser`; the other is not worked out.

    Were its level base there (4, 4).
    """
    by_scan = ViewSurface(_scan_in_map(view, T_map_base), no_surface())
    if by_scan.by_laser:
        return by_scan.scan, True
    return depth_surface_of(view, T_map_base), False


def _scan_in_map(view: View, T_map_base: Array) -> SurfacePoints:
    if view.scan is None or view.T_base_laser is None:
        return no_surface()
    T = T_map_base @ view.T_base_laser
    return surface_of(view.scan).moved(T[:2, :2], T[:2, 3])
