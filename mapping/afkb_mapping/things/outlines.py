"""Simple polygons around cells: closed rings that never touch themselves, as GeoSPARQL wants."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

DECIMALS = 4
"""Corners are kept to a tenth of a millimetre, and are valid as they are written."""


def outline_of_cells(
    mask: NDArray[np.uint8], cell_m: float, low_xy: NDArray[np.float64], axes: str = "xy"
) -> NDArray[np.float64]:
    """Outline (N, 2) of the largest part of a mask, m, open ring, around its cells' borders.

    `low_xy`: corner of cell (0, 0). `axes`: which axis of the mask runs along x: `xy` where its
    first index does, `yx` where its second does. Simplified by less than a cell.
    Raises `ValueError` for an empty mask.
    """
    import cv2
    import shapely

    contours, _ = cv2.findContours(mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_SIMPLE)
    if not contours:
        raise ValueError("an empty mask has no outline")
    pixels = np.asarray(max(contours, key=cv2.contourArea), dtype=np.float64).reshape(-1, 2)
    points = low_xy + (pixels[:, ::-1] if axes == "xy" else pixels) * cell_m + cell_m / 2
    # Growing by half a cell reaches the cells' borders, and gives single cells an area.
    line = shapely.LinearRing(points) if len(points) > 2 else shapely.MultiPoint(points)
    whole = shapely.Polygon(points).buffer(0) if len(points) > 2 else line
    grown = shapely.union(line, whole).buffer(cell_m / 2, join_style="mitre")
    simple = shapely.simplify(_largest(grown), 0.75 * cell_m, preserve_topology=True)
    rounded = _largest(shapely.set_precision(simple, 10.0**-DECIMALS))
    ring: NDArray[np.float64] = np.round(shapely.get_coordinates(rounded.exterior), DECIMALS)
    return ring[:-1]


def _largest(geometry: Any) -> Any:
    """The largest polygon of a geometry, without its holes."""
    import shapely

    parts = [p for p in shapely.get_parts(geometry) if p.geom_type == "Polygon"]
    return shapely.Polygon(max(parts, key=shapely.area).exterior)
