"""Curves of recall and precision over a hardship, as SVG."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

WIDE, HIGH, EDGE = 190, 140, 34
LINES = {
    "supports_recall": ("#27a", "", "supports, recall"),
    "supports_precision": ("#27a", "4 3", "supports, precision"),
    "containers_recall": ("#c63", "", "containers, recall"),
    "containers_precision": ("#c63", "4 3", "containers, precision"),
}
TITLES = {
    "missing": "pixels missing",
    "noise": "noise, times the sensor's",
    "roll": "camera rolled, degrees",
    "width": "image width, px",
    "range": "farthest depth, m",
}


def curves(by_axis: dict[str, Sequence[dict[str, Any]]]) -> str:
    """One panel an axis, from 0 to 1; values stand evenly spaced."""
    shown = [axis for axis in TITLES if axis in by_axis]
    wide, high = EDGE + len(shown) * (WIDE + EDGE), HIGH + 2 * EDGE + 24
    parts = [
        p for i, a in enumerate(shown) for p in _panel(a, by_axis[a], EDGE + i * (WIDE + EDGE))
    ]
    legend = [
        f'<path d="M{EDGE + 180 * i} {high - 12}h24" stroke="{color}" stroke-dasharray="{dash}" '
        f'stroke-width="2"/><text x="{EDGE + 180 * i + 30}" y="{high - 8}">{name}</text>'
        for i, (color, dash, name) in enumerate(LINES.values())
    ]
    return "\n".join(
        (
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {wide} {high}" '
            'font-family="sans-serif" font-size="11">',
            f'<rect width="{wide}" height="{high}" fill="#fff"/>',
            *parts,
            *legend,
            "</svg>\n",
        )
    )


def _panel(axis: str, points: Sequence[dict[str, Any]], x0: float) -> Iterator[str]:
    bottom, step = EDGE + HIGH, WIDE / max(len(points) - 1, 1)
    yield f'<text x="{x0}" y="{EDGE - 12}" font-weight="bold">{TITLES[axis]}</text>'
    yield f'<rect x="{x0}" y="{EDGE}" width="{WIDE}" height="{HIGH}" fill="none" stroke="#999"/>'
    for tick in (0, 0.5, 1):
        yield f'<text x="{x0 - 20}" y="{bottom - tick * HIGH + 4}">{tick:g}</text>'
    for i, p in enumerate(points):
        yield f'<text x="{x0 + i * step - 8}" y="{bottom + 14}">{p["value"]:g}</text>'
    for name, (color, dash, _) in LINES.items():
        at = "L".join(
            f"{x0 + i * step:.1f} {bottom - p[name] * HIGH:.1f}"
            for i, p in enumerate(points)
            if p[name] is not None
        )
        yield (
            f'<path d="M{at}" fill="none" stroke="{color}" stroke-width="2" '
            f'stroke-dasharray="{dash}"/>'
        )
