"""Boxes seen from above."""

from __future__ import annotations

from typing import TYPE_CHECKING

from afkb.flow import OrientedBox

if TYPE_CHECKING:
    from shapely import Polygon


def outline(box: OrientedBox) -> Polygon:
    """A box seen from above, m."""
    import shapely
    from shapely import affinity

    (x, y, _), (a, b, _) = box.center_xyz, box.size_xyz
    flat = shapely.box(x - a / 2, y - b / 2, x + a / 2, y + b / 2)
    return affinity.rotate(flat, box.yaw, origin=(x, y), use_radians=True)
