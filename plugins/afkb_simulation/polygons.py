"""Plane polygons: area, what is inside, and triangles."""

from __future__ import annotations

from collections.abc import Sequence

XY = tuple[float, float]


def signed_area(polygon: Sequence[XY]) -> float:
    """Area, m²; positive where the corners run counter-clockwise."""
    following = [*polygon[1:], polygon[0]]
    pairs = zip(polygon, following, strict=True)
    return sum(a[0] * b[1] - b[0] * a[1] for a, b in pairs) / 2


def contains(polygon: Sequence[XY], point: XY) -> bool:
    """Whether the point lies inside (even-odd rule)."""
    x, y = point
    inside = False
    for (ax, ay), (bx, by) in edges(polygon):
        if (ay > y) != (by > y) and x < ax + (y - ay) * (bx - ax) / (by - ay):
            inside = not inside
    return inside


def edges(polygon: Sequence[XY]) -> list[tuple[XY, XY]]:
    """Its sides, in order."""
    return list(zip(polygon, [*polygon[1:], polygon[0]], strict=True))


def _turn(a: XY, b: XY, c: XY) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def crosses_itself(polygon: Sequence[XY]) -> bool:
    """Whether two of its sides cross."""
    sides = edges(polygon)
    for i, (a, b) in enumerate(sides):
        for c, d in sides[i + 1 :]:
            apart = _turn(a, b, c) * _turn(a, b, d) < 0 and _turn(c, d, a) * _turn(c, d, b) < 0
            if apart:
                return True
    return False


def triangulate(polygon: Sequence[XY]) -> list[tuple[int, int, int]]:
    """Corner indexes of triangles that cover a simple counter-clockwise polygon (ear clipping)."""
    left = list(range(len(polygon)))
    triangles = []
    while len(left) > 3:
        i = next((k for k in range(len(left)) if _is_ear(polygon, left, k)), 0)
        triangles.append((left[i - 1], left[i], left[(i + 1) % len(left)]))
        del left[i]
    return [*triangles, (left[0], left[1], left[2])]


def _is_ear(polygon: Sequence[XY], left: Sequence[int], i: int) -> bool:
    corner = (left[i - 1], left[i], left[(i + 1) % len(left)])
    a, b, c = (polygon[k] for k in corner)
    if _turn(a, b, c) <= 0:
        return False
    others = (polygon[k] for k in left if k not in corner)
    return not any(
        _turn(a, b, p) >= 0 and _turn(b, c, p) >= 0 and _turn(c, a, p) >= 0 for p in others
    )
