"""The counts that ship with the ontology speak of what its tables have."""

from __future__ import annotations

from pathlib import Path

import pytest

from afkb.csv_rows import read_rows
from afkb.figures import Counts, Figures, read_counts

ONTOLOGY = Path(__file__).parents[2] / "ontology"
COUNT_AGAIN = "count again: see ontology/counts/README.md"


@pytest.fixture(scope="module")
def counts() -> Counts:
    return read_counts(ONTOLOGY / "counts")


def column(name: str, *tables: Path) -> set[str]:
    return {row[name] for table in tables for row in read_rows(table, [name])}


def test_categories_and_rooms_are_those_of_the_tables(counts: Counts) -> None:
    categories = column("name", *(ONTOLOGY / "tables" / "categories").glob("*.csv"))
    rooms = column("room", ONTOLOGY / "tables" / "room_names.csv")
    supports = {s for placed in counts.supports.values() for s in placed}
    counted = {c for source in counts.sources.values() for c in source.categories}
    assert counted | supports <= categories, COUNT_AGAIN
    assert {r for b in counts.buildings.values() for r in b.rooms if r} <= rooms, COUNT_AGAIN


def test_what_everybody_knows_of_homes_is_in_the_figures(counts: Counts) -> None:
    figures = Figures(counts)
    assert figures.object_in_room("Bed", "Bedroom").p > 0.8
    assert figures.object_in_room("Toilet", "Bathroom").p > 0.7
    assert figures.object_in_room("Bed", "Kitchen").p < 0.05
    assert figures.object_with_object("Pillow", "Bed").p > 0.7
    assert figures.object_in_room("Stairs", "Stairwell").p > 0.7
    assert figures.object_in_room("Chair", "Porch").source.startswith("matterport")
    assert figures.object_in_room("Wall", "Hallway").p > 0.9, "though viewpoints name few walls"
    assert "Desk" in list(figures.support_of("Pen"))[:2]
    for thing in {thing for _, thing in counts.supports}:
        shares = figures.support_of(thing).values()
        assert sum(f.p for f in shares) == pytest.approx(1)
