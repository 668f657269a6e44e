"""The reliability diagram, as SVG."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

SIDE, EDGE = 240, 40
COLORS = {"scored": "#c33", "held_out": "#27a", "shipped": "#393"}
NAMES = {"scored": "as scored", "held_out": "other buildings' curves", "shipped": "shipped"}


def diagram(result: dict[str, Any], groups: Sequence[str]) -> str:
    """One panel a group: stated probability against the share that is right.

    Circles grow with the root of the count; on the diagonal, what is stated comes true.
    """
    wide = EDGE + len(groups) * (SIDE + EDGE)
    high = SIDE + 2 * EDGE + 20
    parts = [p for i, g in enumerate(groups) for p in _panel(result, g, EDGE + i * (SIDE + EDGE))]
    return "\n".join(
        (
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {wide} {high}" '
            'font-family="sans-serif" font-size="11">',
            f'<rect width="{wide}" height="{high}" fill="#fff"/>',
            *parts,
            *_legend(high - 8),
            "</svg>\n",
        )
    )


def _panel(result: dict[str, Any], group: str, x0: float) -> Iterator[str]:
    y0 = EDGE + SIDE
    yield f'<text x="{x0}" y="{EDGE - 12}" font-weight="bold">{group}</text>'
    yield f'<rect x="{x0}" y="{EDGE}" width="{SIDE}" height="{SIDE}" fill="none" stroke="#999"/>'
    yield f'<path d="M{x0} {y0}L{x0 + SIDE} {EDGE}" stroke="#bbb"/>'
    for tick in (0, 0.5, 1):
        yield f'<text x="{x0 + tick * SIDE - 6}" y="{y0 + 14}">{tick:g}</text>'
        yield f'<text x="{x0 - 18}" y="{y0 - tick * SIDE + 4}">{tick:g}</text>'
    for way, color in COLORS.items():
        measured = result[way].get(group)
        if measured is None:
            continue
        at = [
            (x0 + b["stated"] * SIDE, y0 - b["right"] * SIDE, b["count"]) for b in measured["bins"]
        ]
        line = "L".join(f"{x:.1f} {y:.1f}" for x, y, _ in at)
        yield f'<path d="M{line}" fill="none" stroke="{color}"/>'
        for x, y, count in at:
            r = 1.5 + 10 * (count / measured["samples"]) ** 0.5
            yield f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{r:.1f}" fill="{color}" opacity="0.5"/>'


def _legend(y: float) -> Iterator[str]:
    for i, (way, color) in enumerate(COLORS.items()):
        yield f'<text x="{EDGE + i * 150}" y="{y}" fill="{color}">{NAMES[way]}</text>'
