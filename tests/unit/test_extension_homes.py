from pathlib import Path

import pytest

from afkb.knowledge import AfNet
from afkb.store import query

HOMES = """building,room,category,objects
my-flat,r1,workshop,cactus stand:2|mug:1
my-flat,r2,kitchen,mug:9|cactus stand:1
"""
EXTENSION = """extension: my
categories:
  CactusStand:
    label: cactus stand
    broader: Furniture
    length_m: [0.2, 0.4]
    width_m: [0.2, 0.4]
    height_m: [0.5, 0.9]
    afbits: ["SupportAbility = 0.95"]
rooms:
  Workshop: {label: workshop, definition: A room to make things in., expected_number: 0.1}
homes: [homes.csv]
"""
FIGURES = """
PREFIX my: <https://example.org/my#>
SELECT ?category ?room ?successes ?trials WHERE {
  ?figure a afn:ObjectInRoom ; afn:ofCategory ?category ; afn:ofRoom ?room ;
          afn:successes ?successes ; afn:trials ?trials .
  FILTER(STRSTARTS(STR(?figure), STR(my:)))
} ORDER BY ?figure
"""


@pytest.fixture
def extension(tmp_path: Path) -> Path:
    (tmp_path / "homes.csv").write_text(HOMES)
    (tmp_path / "my.yaml").write_text(EXTENSION)
    return tmp_path / "my.yaml"


def test_own_homes_are_counted_in(extension: Path) -> None:
    bundled, mine = AfNet().figures, AfNet(extensions=[extension]).figures
    before, after = (f.object_in_room("Mug", "Kitchen") for f in (bundled, mine))
    assert (after.successes, after.trials) == (before.successes + 1, before.trials + 1)
    assert after.buildings == before.buildings + 1
    assert mine.object_in_room("CactusStand", "Workshop").trials == 1


def test_the_network_reads_figures_with_own_homes_counted_in(extension: Path) -> None:
    kb = AfNet(extensions=[extension])
    mugs = [f for f in kb.objects_in_rooms if (f.category, f.room) == ("Mug", "Kitchen")]
    assert len(mugs) == 1
    before = AfNet().figures.object_in_room("Mug", "Kitchen")
    assert (mugs[0].successes, mugs[0].trials) == (1, 1)
    assert mugs[0].probability == pytest.approx((1 + 8 * before.p) / 9, rel=1e-3)
    stands = {f.room: f for f in kb.objects_in_rooms if f.category == "CactusStand"}
    assert stands["Workshop"].trials == 1
    assert stands["Workshop"].mean_number > stands["Kitchen"].mean_number


def test_sparql_answers_with_own_homes(extension: Path) -> None:
    found = query([], FIGURES, AfNet(extensions=[extension]).files).cells()
    mug = next(row for row in found if row[0] == "afn:Mug" and row[1] == "afn:Kitchen")
    assert [float(cell) for cell in mug[2:]] == [1, 1]
    assert {row[:2] for row in found} >= {
        ("https://example.org/my#CactusStand", "https://example.org/my#Workshop")
    }


def test_homes_that_change_are_counted_anew(extension: Path) -> None:
    first = AfNet(extensions=[extension])
    assert len(query([], FIGURES, first.files).cells()) == 4
    (extension.parent / "homes.csv").write_text(HOMES + "my-flat,r3,kitchen,teapot:1\n")
    assert len(query([], FIGURES, AfNet(extensions=[extension]).files).cells()) == 6


def test_a_table_of_homes_that_is_given_twice_counts_once(extension: Path) -> None:
    other = extension.parent / "other.yaml"
    other.write_text("extension: other\nhomes: [homes.csv]\n")
    mine = AfNet(extensions=[extension, other]).figures
    assert mine.object_in_room("CactusStand", "Workshop").trials == 1
