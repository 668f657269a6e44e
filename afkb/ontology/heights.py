"""How high above the floor things stand or hang: stated, by their tops, or by their supports."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

from afkb.csv_rows import Row
from afkb.errors import KnowledgeError

if TYPE_CHECKING:
    from afkb.figures import Figures

USUAL_SUPPORT_M = (0.40, 1.05)
"""Tops from a low table to a counter: where things stand of which no table says what bears them."""
_ON_FLOOR_M = (0.0, 0.02)
_TAIL = 0.1
"""Share of the placements that is left out at either end."""


def with_undersides(rows: Iterable[Row], figures: Figures | None = None) -> list[Row]:
    """Category rows with the height of the underside above the floor, m, and where it is from.

    What stands on the floor has it there; what has a top at a known height, a height below that;
    what is put on things, where their tops are, weighted by how often it is put on each.
    """
    rows = list(rows)
    tops = {r["name"]: _middle(r, "top") for r in rows if r.get("top_min_m")}
    return [_with_underside(row, tops, figures) for row in rows]


def _with_underside(row: Row, tops: Mapping[str, float], figures: Figures | None) -> Row:
    if row.get("underside_min_m"):
        return _stated(row, row.number("underside_min_m"), row.number("underside_max_m"), "stated")
    if row.get("stands_on") == "Floor":
        return _stated(row, *_ON_FLOOR_M, "stands on the floor")
    if row.get("top_min_m"):
        half = (row.number("height_min_m") + row.number("height_max_m")) / 2
        low, high = (max(0.0, row.number(f"top_{end}_m") - half) for end in ("min", "max"))
        return _stated(row, low, high, "typical top less typical height")
    low, high, source = _of_supports(row["name"], tops, figures)
    return _stated(row, 0.0 if row.get("stands_on") == "Anything" else low, high, source)


def _of_supports(
    name: str, tops: Mapping[str, float], figures: Figures | None
) -> tuple[float, float, str]:
    try:
        on = figures.support_of(name) if figures is not None else {}
    except KnowledgeError:
        on = {}
    placed = sorted((tops[s], f.successes) for s, f in on.items() if s in tops and f.successes)
    total = sum(number for _, number in placed)
    if total < 1:
        return *USUAL_SUPPORT_M, "tops from a low table to a counter; proposed"
    source = next(iter(on.values())).source
    return (
        _quantile(placed, _TAIL * total),
        _quantile(placed, (1 - _TAIL) * total),
        f"tops of what it is put on, {total:.0f} placements in {source}",
    )


def _quantile(placed: list[tuple[float, float]], rank: float) -> float:
    reached = 0.0
    for top, number in placed:
        reached += number
        if reached >= rank:
            return top
    return placed[-1][0]


def _stated(row: Row, low: float, high: float, source: str) -> Row:
    cells = {
        "underside_min_m": f"{low:.3g}",
        "underside_max_m": f"{max(high, low):.3g}",
        "underside_from": source,
    }
    return replace(row, cells=row.cells | cells)


def _middle(row: Row, what: str) -> float:
    return (row.number(f"{what}_min_m") + row.number(f"{what}_max_m")) / 2
