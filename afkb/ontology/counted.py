"""Figures that were counted in homes, as rows of the ontology with the counts behind them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from afkb.csv_rows import Row
from afkb.ontology.schema import Table

if TYPE_CHECKING:
    from afkb.figures import Figure, Figures, InRoom

IN_ROOM = Table("figures", "ObjectInRoom", ("object", "room"), suffix="InRoom")
TOGETHER = Table("figures", "ObjectWithObject", ("object", "given"), suffix="Together")
ON_SUPPORT = Table("figures", "ObjectOnSupport", ("object", "given"), suffix="Support")

LEAST_ROOMS, LEAST_PAIRS, LEAST_PLACEMENTS = 3, 10, 3
"""Rooms, rooms with both, and placements from which on a figure is stated; the counts have all."""
LEAST_LIFT, LEAST_P = 2.0, 0.2
"""A pair is stated where it is so many times likelier than anywhere, and at least so likely."""


def counted_rows(figures: Figures) -> Iterator[tuple[Table, Row]]:
    """The figures that the ontology states: in rooms, beside each other and on supports."""
    for place in figures.in_rooms(LEAST_ROOMS):
        yield IN_ROOM, in_room_row(place)
    for pair in figures.together(LEAST_PAIRS):
        if pair.figure.p < max(LEAST_P, LEAST_LIFT * figures.base_rate(pair.category)):
            continue
        label = f"P({pair.category} | {pair.given} in the room)"
        cells = {"object": pair.category, "given": pair.given, "label": label}
        yield TOGETHER, _row("pairs.csv", cells, pair.figure)
    for on in figures.supports(LEAST_PLACEMENTS):
        label = f"P({on.support} below | {on.thing})"
        cells = {"object": on.support, "given": on.thing, "label": label}
        yield ON_SUPPORT, _row("supports.csv", cells, on.figure)


def in_room_row(place: InRoom) -> Row:
    """The row that states how likely a category is in a room, and how many there are."""
    cells = {
        "object": place.category,
        "room": place.room,
        "label": f"P({place.category} in a {place.room})",
        "mean_number": _number(place.number.mean),
    }
    return _row("rooms.csv", cells, place.figure)


def _row(file: str, cells: dict[str, str], figure: Figure) -> Row:
    counted = {
        "probability": _number(figure.p),
        "successes": _number(figure.successes),
        "trials": _number(figure.trials),
        "buildings": str(figure.buildings),
        "status": "taken from data",
        "source": f"counted in {figure.source}; smoothed, see counts/README.md",
    }
    return Row(f"counts/{file}", 0, cells | counted)


def _number(value: float) -> str:
    return f"{value:.4g}"
