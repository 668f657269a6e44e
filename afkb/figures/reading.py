"""Reads what was seen in rooms, from tables of three shapes."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path

from afkb.csv_rows import Row, read_header, read_rows
from afkb.errors import KnowledgeError
from afkb.figures.names import HOMES


class Shape(StrEnum):
    """The tables that can be counted; `auto` tells them by their header."""

    AUTO = "auto"
    HM3D = "hm3d"
    MATTERPORT = "matterport"
    HOMES = HOMES


@dataclass(frozen=True, slots=True)
class Layout:
    """Which columns of a shape say what, and what its rows are worth.

    `unit_weight`: a viewpoint sees a part of a room and shares it with its neighbours. The public
    tour has about five viewpoints to a room, so that one counts as a fifth of a room (proposed).
    `empty_says_nothing`: rows without things are unlabelled there rather than bare.
    """

    columns: tuple[str, str, str, str]
    unit: str = "room"
    unit_weight: float = 1.0
    empty_says_nothing: bool = True


LAYOUTS = {
    Shape.HM3D: Layout(("scene", "region", "category_by_votes", "objects")),
    Shape.MATTERPORT: Layout(
        ("building", "viewpoint", "class_inferred", "objects"), unit="viewpoint", unit_weight=0.2
    ),
    Shape.HOMES: Layout(("building", "room", "category", "objects"), empty_says_nothing=False),
}


@dataclass(frozen=True, slots=True)
class SeenRoom:
    """One row: a room, or a viewpoint in one, with its things under their source's names."""

    building: str
    room: str
    category: str
    things: dict[str, int]


def shape_of(path: Path) -> Shape:
    """The shape of a table of rooms, by its header."""
    header = set(read_header(path))
    for shape, layout in LAYOUTS.items():
        if header.issuperset(layout.columns):
            return shape
    raise KnowledgeError(
        f"{path}, line 1: columns {','.join(sorted(header))} are of no known shape; "
        f"for homes of your own write {','.join(LAYOUTS[Shape.HOMES].columns)}"
    )


def seen_rooms(paths: Sequence[Path], shape: Shape) -> Iterator[SeenRoom]:
    """The rows of tables of one shape, in their order; `KnowledgeError` for a room that's twice."""
    columns = LAYOUTS[shape].columns
    first_at: dict[tuple[str, str], str] = {}
    for path in paths:
        for row in read_rows(path, columns):
            building, room, category, objects = (row[column].strip() for column in columns)
            if not building or not room:
                raise row.error(f"{columns[0]} or {columns[1]} is empty; name both")
            if (building, room) in first_at:
                raise row.error(
                    f"{columns[1]} {room!r} of {building!r} stands in {first_at[building, room]} "
                    "already; count each once"
                )
            first_at[building, room] = f"{path.name}, line {row.line}"
            yield SeenRoom(building, room, category, _things(row, objects))


def _things(row: Row, objects: str) -> dict[str, int]:
    """The things of a cell as in `bed:1|desk lamp:2`."""
    things: Counter[str] = Counter()
    for entry in objects.split("|") if objects else ():
        name, colon, number = (part.strip() for part in entry.rpartition(":"))
        if not (colon and name):
            raise row.error(f"objects has {entry!r}; write name:count, as in bed:1|desk lamp:2")
        count = row.whole_number(number, f"the count of {name!r}")
        if not count:
            raise row.error(f"the count of {name!r} is 0; leave out what isn't there")
        things[name] += count
    return dict(things)
