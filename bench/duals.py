"""What rooms say of displays and of what writes: how often the one is in a room with the other.

    python -m bench.duals ROOMS.csv ... [--tables ontology/tables] [--json]

The paper lets displays suggest pens, and pens displays only weakly (§II.D.ii). For each table of
rooms (`afkb ontology count` knows the shapes), over all its rooms, named or not: rooms with a thing
that writes (trait WritingTip), with a display of each kind (traits), and with both. Rates are told
with their 95 % Wilson intervals.
"""

from __future__ import annotations

import argparse
import csv
import json
import math
import sys
from pathlib import Path

from afkb.figures import Names
from afkb.figures.reading import seen_rooms, shape_of

TABLES = Path(__file__).parents[1] / "ontology" / "tables"
WRITING = {"WritingTip"}
DISPLAYS = {
    "screens": {"ScreenFace"},
    "what is written on": {"WritableFace"},
    "screens, what is written on, books": {"ScreenFace", "WritableFace"},
    "any display, pictures and clocks too": {"ScreenFace", "WritableFace", "PrintedFace"},
}
BOOKS = {"screens, what is written on, books": {"Book", "Magazine"}}


def with_traits(tables: Path, traits: set[str]) -> set[str]:
    """The categories that have one of the traits."""
    found = set()
    for path in sorted((tables / "categories").glob("*.csv")):
        with path.open(encoding="utf-8", newline="") as file:
            rows = csv.DictReader(file)
            found |= {r["name"] for r in rows if traits & set(r["traits"].split("|"))}
    return found


def rooms_of(path: Path, names: Names) -> list[set[str]]:
    """The categories in each room of a table."""
    shape = shape_of(path)
    found = [
        {names.categories.find(str(shape), called) for called in room.things}
        for room in seen_rooms([path], shape)
    ]
    return [{category for category in room if category} for room in found]


def compare(rooms: list[set[str]], tables: Path) -> dict[str, object]:
    writing = with_traits(tables, WRITING)
    rows = {}
    for kind, traits in DISPLAYS.items():
        display = (with_traits(tables, traits) | BOOKS.get(kind, set())) - writing
        wrote = [bool(room & writing) for room in rooms]
        showed = [bool(room & display) for room in rooms]
        both = sum(w and s for w, s in zip(wrote, showed, strict=True))
        rows[kind] = {
            "display_suggests_pen": rate(both, sum(showed)),
            "pen_suggests_display": rate(both, sum(wrote)),
            "pen_in_any_room": rate(sum(wrote), len(rooms)),
            "display_in_any_room": rate(sum(showed), len(rooms)),
        }
    return rows


def rate(successes: int, trials: int, z: float = 1.96) -> dict[str, object]:
    """A rate with its counts and its Wilson interval."""
    if not trials:
        return {"rate": None, "of": [successes, trials]}
    p, spread = successes / trials, z * z / trials
    middle = (p + spread / 2) / (1 + spread)
    half = z * math.sqrt(p * (1 - p) / trials + spread / (4 * trials)) / (1 + spread)
    interval = [round(middle - half, 3), round(middle + half, 3)]
    return {"rate": round(p, 3), "of": [successes, trials], "interval": interval}


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("rooms", nargs="+", type=Path)
    parser.add_argument("--tables", type=Path, default=TABLES)
    parser.add_argument("--json", action="store_true")
    arguments = parser.parse_args()
    names = Names.load(arguments.tables)
    result = {
        path.name: compare(rooms_of(path, names), arguments.tables) for path in arguments.rooms
    }
    if arguments.json:
        json.dump(result, sys.stdout, indent=1)
        return 0
    for table, kinds in result.items():
        for kind, row in kinds.items():
            sys.stdout.write(f"{table}: {kind}\n")
            for what, value in row.items():
                sys.stdout.write(f"  {what:>22}  {value}\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
