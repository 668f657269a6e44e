"""SVG text for the plan: metres in, y up; the page scales it and computes nothing else."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from html import escape

import numpy as np
from numpy.typing import NDArray

Point = Sequence[float] | NDArray[np.float64]
Points = Iterable[Point] | NDArray[np.float64]
SCALE = 100.0
"""Drawing units in a metre; the page's scripts know it too."""


def number(value: float) -> str:
    """A length in drawing units, to a tenth of a millimetre."""
    return f"{round(value * SCALE, 2) + 0.0:g}"


def at(x: float, y: float) -> str:
    """A point of the map frame in the drawing, whose y goes down."""
    return f"{number(x)},{number(-y)}"


def turned(x: float, y: float, yaw: float) -> str:
    """The transform of what is drawn along x at the origin, to a pose of the map frame (m, rad)."""
    return f"translate({at(x, y)}) rotate({round(-math.degrees(yaw), 2) + 0.0:g})"


def tag(name: str, attributes: Mapping[str, str], title: str = "") -> str:
    """An SVG element; a title becomes its tooltip."""
    written = "".join(f' {key}="{escape(value)}"' for key, value in attributes.items())
    inside = f"<title>{escape(title)}</title>" if title else ""
    return f"<{name}{written}>{inside}</{name}>"


def circle(
    kind: str, x: float, y: float, radius: float, title: str = "", id_: str | None = None
) -> str:
    """A circle of a CSS class; `id_`: of the node that it stands for."""
    facts = {"class": kind, **_named(id_)}
    return tag("circle", facts | {"cx": number(x), "cy": number(-y), "r": number(radius)}, title)


def box(
    kind: str,
    pose: tuple[float, float, float],
    size: tuple[float, float],
    title: str = "",
    id_: str | None = None,
) -> str:
    """An upright box seen from above: x, y, yaw of its middle, its sizes along and across (m)."""
    (x, y, yaw), (along, across) = pose, size
    facts = {
        "class": kind,
        **_named(id_),
        "x": number(-along / 2),
        "y": number(-across / 2),
        "width": number(along),
        "height": number(across),
        "transform": turned(x, y, yaw),
    }
    return tag("rect", facts, title)


def ray(
    kind: str,
    pose: tuple[float, float, float],
    reach: tuple[float, float],
    title: str = "",
    id_: str | None = None,
) -> str:
    """A straight line through a pose along its yaw, from reach to reach (m)."""
    start, end = reach
    facts = {"class": kind, **_named(id_), "x1": number(start), "x2": number(end)}
    return tag("line", facts | {"transform": turned(*pose)}, title)


def line(kind: str, start: Point, end: Point, title: str = "", id_: str | None = None) -> str:
    """A straight line of a CSS class."""
    return path(kind, [start, end], False, title, id_)


def edge(kind: str, start: Point, end: Point, ends: tuple[str, str], id_: str, title: str) -> str:
    """A line between two nodes: it is only there where both of them are."""
    drawn = line(kind, start, end, title, id_)
    return drawn.replace(" points=", f' data-ends="{escape(" ".join(ends))}" points=', 1)


def path(kind: str, points: Points, closed: bool, title: str = "", id_: str | None = None) -> str:
    """A polyline or polygon of a CSS class."""
    corners = " ".join(at(float(p[0]), float(p[1])) for p in points)
    facts = {"class": kind, **_named(id_), "points": corners}
    return tag("polygon" if closed else "polyline", facts, title)


def text(kind: str, x: float, y: float, content: str, id_: str | None = None) -> str:
    """A label, centred on the point."""
    facts = {"class": kind, **_named(id_), "x": number(x), "y": number(-y)}
    return tag("text", facts).replace("></text>", f">{escape(content)}</text>")


def group(kind: str, parts: Iterable[str]) -> str:
    """Elements that are shown and hidden together."""
    return f'<g class="{escape(kind)}">\n' + "\n".join(parts) + "\n</g>"


def _named(id_: str | None) -> dict[str, str]:
    return {} if id_ is None else {"data-id": id_}
