"""SVG text for the plan: metres in, y up; the page scales it."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from html import escape

import numpy as np
from numpy.typing import NDArray

Point = Sequence[float] | NDArray[np.float64]
Points = Iterable[Point] | NDArray[np.float64]
SCALE = 100.0


def number(value: float) -> str:
    """A length in drawing units, to a tenth of a millimetre."""
    return f"{round(value * SCALE, 2) + 0.0:g}"


def at(x: float, y: float) -> str:
    """A point of the map frame in the drawing, whose y goes down."""
    return f"{number(x)},{number(-y)}"


def tag(name: str, attributes: dict[str, str], title: str = "") -> str:
    """An SVG element; a title becomes its tooltip."""
    written = "".join(f' {key}="{escape(value)}"' for key, value in attributes.items())
    inside = f"<title>{escape(title)}</title>" if title else ""
    return f"<{name}{written}>{inside}</{name}>"


def circle(kind: str, x: float, y: float, radius: float, title: str = "") -> str:
    """A circle of a CSS class."""
    facts = {"class": kind, "cx": number(x), "cy": number(-y), "r": number(radius)}
    return tag("circle", facts, title)


def line(kind: str, start: Point, end: Point, title: str = "") -> str:
    """A straight line of a CSS class."""
    return path(kind, [start, end], False, title)


def path(kind: str, points: Points, closed: bool, title: str = "") -> str:
    """A polyline or polygon of a CSS class."""
    corners = " ".join(at(float(p[0]), float(p[1])) for p in points)
    return tag("polygon" if closed else "polyline", {"class": kind, "points": corners}, title)


def text(kind: str, x: float, y: float, content: str) -> str:
    """A label, centred on the point."""
    return f'<text class="{escape(kind)}" x="{number(x)}" y="{number(-y)}">{escape(content)}</text>'


def group(kind: str, parts: Iterable[str]) -> str:
    """Elements that are shown and hidden together."""
    return f'<g class="{escape(kind)}">\n' + "\n".join(parts) + "\n</g>"


def box_corners(
    x: float, y: float, size_x: float, size_y: float, yaw: float
) -> list[tuple[float, float]]:
    """Corners of an upright box seen from above, map frame, m."""
    c, s = math.cos(yaw), math.sin(yaw)
    halves = [(-size_x, -size_y), (size_x, -size_y), (size_x, size_y), (-size_x, size_y)]
    return [(x + (c * a - s * b) / 2, y + (s * a + c * b) / 2) for a, b in halves]
