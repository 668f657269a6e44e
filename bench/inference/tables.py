"""Tables of rooms as a benchmark reads them: rows, folds by building, and networks of rows."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from itertools import combinations
from pathlib import Path

from afkb.csv_rows import Row
from afkb.figures import Figures, Names
from afkb.figures.counts import Building, Counts, RoomTally, Source
from afkb.figures.figure import InRoom
from afkb.figures.reading import LAYOUTS, SeenRoom, Shape, seen_rooms, shape_of
from afkb.inference.holdings import Stated, shares_of
from afkb.knowledge import AfNet, ObjectInRoom, ObjectWithObject
from afkb.ontology.counted import TOGETHER, counted_rows
from bench.detectors.data import NoData
from bench.figures import fold_of

TABLES = Path(__file__).parents[2] / "ontology" / "tables"


@dataclass(frozen=True)
class RoomRow:
    """One row: a room, or a viewpoint in one, with our names; `room` is "" where it has none.

    `told`: how many things it tells, those of unknown names too.
    """

    building: str
    number: str
    room: str
    things: Counter[str]
    told: int


@dataclass(frozen=True)
class Table:
    """The rows of a file, and what one of them is worth in rooms."""

    rows: tuple[RoomRow, ...]
    unit_weight: float

    def split(self, fold: int, folds: int) -> tuple[Table, list[int]]:
        """The rows of the other buildings, and the indexes of those of this fold's."""
        own = [i for i, row in enumerate(self.rows) if fold_of(row.building, folds) == fold]
        rest = set(range(len(self.rows))) - set(own)
        return Table(tuple(self.rows[i] for i in sorted(rest)), self.unit_weight), own

    def where(self, keep: Callable[[RoomRow], bool]) -> Table:
        """The rows that are to be kept."""
        return Table(tuple(row for row in self.rows if keep(row)), self.unit_weight)


def read_table(path: Path, names: Names | None) -> Table:
    """A file of a known shape; without names of ours, under those of the file.

    Raises `NoData` where it isn't there.
    """
    if not path.is_file():
        raise NoData(f"{path}: no such table of rooms; name one")
    shape = shape_of(path)
    rows = tuple(_row(seen, names, shape) for seen in seen_rooms([path], shape))
    return Table(rows, LAYOUTS[shape].unit_weight)


def _row(seen: SeenRoom, names: Names | None, shape: Shape) -> RoomRow:
    room: str | None = seen.category
    things = Counter(seen.things)
    if names is not None:
        room = names.rooms.find(str(shape), seen.category)
        things = Counter()
        for called, number in seen.things.items():
            category = names.categories.find(str(shape), called)
            if category:
                things[category] += number
    return RoomRow(seen.building, seen.room, room or "", things, sum(seen.things.values()))


def figures_of(table: Table) -> Figures:
    """What the rows tell, each a room of its category, as figures."""
    source = "table"
    buildings: defaultdict[str, Building] = defaultdict(Building)
    for row in table.rows:
        tally = RoomTally(1, dict.fromkeys(row.things, 1), dict(row.things))
        pairs = dict.fromkeys(combinations(sorted(row.things), 2), 1)
        buildings[row.building] = buildings[row.building].plus(Building({row.room: tally}, pairs))
    known = frozenset(category for row in table.rows for category in row.things)
    told = Source(source, True, "row", table.unit_weight, known)
    return Figures(Counts({source: told}, {(source, b): c for b, c in buildings.items()}))


def stated_by(own: Figures, in_rooms: Iterable[InRoom], rooms: Sequence[str], kb: AfNet) -> Stated:
    """What figures state, as an ontology built from them would; the network's numbers are `kb`'s.

    The rooms' shares are those among the rows.
    """
    tallies = [b.rooms for b in own.counts.buildings.values()]
    together = (row for listed, row in counted_rows(own) if listed is TOGETHER)
    return Stated(
        rooms={r: 1.0 + sum(t[r].rooms for t in tallies if r in t) for r in rooms},
        categories=dict.fromkeys(own.categories(), 1e-3),
        in_rooms=tuple(map(_in_room, in_rooms)),
        together=tuple(map(_together, together)),
        shares=shares_of(kb),
        stray=kb.parameters["StrayShare"],
    )


def _in_room(told: InRoom) -> ObjectInRoom:
    return ObjectInRoom(
        **_named(f"{told.category}.{told.room}.InRoom"),
        category=told.category,
        room=told.room,
        probability=told.figure.p,
        mean_number=told.number.mean,
        successes=told.figure.successes,
        trials=told.figure.trials,
    )


def _together(row: Row) -> ObjectWithObject:
    return ObjectWithObject(
        **_named(f"{row['object']}.{row['given']}.Together"),
        category=row["object"],
        given=row["given"],
        probability=float(row["probability"]),
        successes=float(row["successes"]),
        trials=float(row["trials"]),
    )


def _named(name: str) -> dict[str, str]:
    return {
        "name": name,
        "iri": "",
        "label": name,
        "status": "taken from data",
        "source": "the table",
        "place": "",
    }
