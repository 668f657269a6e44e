"""One scan in an earlier map, where each way of matching puts it: as an SVG."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.geometry import T_from_xy_yaw
from bench.mapping.deceived_visits import Match

Array = NDArray[np.float64]

PIXELS_PER_M = 60.0
MARGIN_M = 0.5
HEAD = 60
"""Pixels above the map, for what the colours say."""
COLOURS = {"metric": "#d02020", "affordance": "#1860c8", "static": "#189048"}
SAID = {
    "metric": "matched with all alike",
    "affordance": "matched by movability",
    "static": "what moves left out",
}
STYLE = "font-family:sans-serif;font-size:14px"


def picture(match: Match) -> str:
    """The map's cells, its dynamic things, and what the view meets by each way of matching."""
    assert match.view.T_map_base is not None
    grid = match.grid
    cells = grid.origin_xy + (np.argwhere(match.occupied)[:, ::-1] + 0.5) * grid.resolution_m
    low, high = cells.min(axis=0) - MARGIN_M, cells.max(axis=0) + MARGIN_M
    width, height = (high - low) * PIXELS_PER_M
    parts = [_dots(cells, low, high, "#b0b0b0", grid.resolution_m / 2)]
    for thing in match.moving:
        corners = " ".join(f"{x:.1f},{y:.1f}" for x, y in _pixels(thing.polygon_xy, low, high))
        parts.append(f'<polygon points="{corners}" fill="#f5c84255" stroke="#c89000"/>')
    at = match.view.T_map_base[:2, 3]
    for number, (name, (dx, dy, turn)) in enumerate(match.off.items()):
        R = T_from_xy_yaw(0.0, 0.0, turn)[:2, :2]
        parts.append(
            _dots((match.ends_xy - at) @ R.T + at + (dx, dy), low, high, COLOURS[name], 0.02)
        )
        off = f"{SAID[name]}: {np.hypot(dx, dy):.2f} m and {np.degrees(abs(turn)):.1f}° off"
        where = f'x="8" y="{18 * number - HEAD + 14}" fill="{COLOURS[name]}" style="{STYLE}"'
        parts.append(f"<text {where}>{off}</text>")
    box = f"0 {-HEAD} {width:.0f} {height + HEAD:.0f}"
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{box}">\n'
        f'<rect y="{-HEAD}" width="100%" height="100%" fill="white"/>\n'
        + "\n".join(parts)
        + "\n</svg>\n"
    )


def _pixels(points_xy: Array, low: Array, high: Array) -> Array:
    pixels: Array = np.column_stack([points_xy[:, 0] - low[0], high[1] - points_xy[:, 1]])
    return pixels * PIXELS_PER_M


def _dots(points_xy: Array, low: Array, high: Array, colour: str, radius_m: float) -> str:
    r = radius_m * PIXELS_PER_M
    path = "".join(
        f"M{x - r:.1f} {y - r:.1f}h{2 * r:.1f}v{2 * r:.1f}h{-2 * r:.1f}z"
        for x, y in _pixels(points_xy, low, high)
    )
    return f'<path d="{path}" fill="{colour}"/>'
