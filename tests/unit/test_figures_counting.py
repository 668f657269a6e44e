from __future__ import annotations

from pathlib import Path

import pytest

from afkb.errors import KnowledgeError
from afkb.figures import (
    Figures,
    Names,
    Shape,
    count_rooms,
    read_counts,
    read_simulated,
    write_counts,
)
from afkb.figures.reading import shape_of
from figures_samples import HM3D, MATTERPORT, SOURCE_NAMES, counted, tables, write

HOMES_HEADER = "building,room,category,objects\n"


def test_rooms_are_counted_by_building_and_room_category(tmp_path: Path) -> None:
    counts = counted(tmp_path, HM3D)
    bedrooms = counts.buildings["hm3d", "A"].rooms["Bedroom"]
    assert bedrooms.rooms == 2
    assert bedrooms.holding == {"Bed": 2, "Pillow": 1}
    assert bedrooms.things == {"Bed": 3, "Pillow": 3}
    assert counts.buildings["hm3d", "A"].pairs == {("Bed", "Pillow"): 1}
    assert counts.buildings["hm3d", "B"].rooms["Kitchen"].things == {"Mug": 4}


def test_ties_unknown_rooms_empty_rows_and_unknown_names_are_left_out_and_told(
    tmp_path: Path,
) -> None:
    path = write(tmp_path / "rooms.csv", HM3D)
    counts, unknown = count_rooms([path], Names.load(tables(tmp_path / "tables")))
    assert counts.sources["hm3d"].left_out == {
        "rooms of no known category": 1,
        "rooms of tied categories": 1,
        "rooms empty": 1,
        "things of unknown name": 3,
    }
    assert unknown.things["hm3d"] == {"yoke": 3}
    assert unknown.rooms["hm3d"] == {"Unknown room": 1, "Tie: Bedroom & Kitchen": 1}


def test_a_viewpoint_counts_as_a_part_of_a_room(tmp_path: Path) -> None:
    counts = counted(tmp_path, MATTERPORT)
    assert counts.buildings["matterport", "M"].rooms["Bedroom"].rooms == 2
    source = counts.sources["matterport"]
    assert (source.unit, source.weight) == ("viewpoint", 0.2)


def test_a_source_knows_the_categories_of_which_it_has_a_name(tmp_path: Path) -> None:
    counts = counted(tmp_path, HM3D, MATTERPORT, HOMES_HEADER + "H,r,kitchen,mug:1\n")
    known = {name: sorted(source.categories) for name, source in counts.sources.items()}
    assert known == {
        "hm3d": ["Bed", "Mug", "Pillow"],
        "matterport": ["Bed", "Pillow"],
        "homes": ["Mug"],
    }


@pytest.mark.parametrize("called", ["Mug", "mug", "Tea_Mug", "tea#mug"])
def test_homes_may_use_any_name_in_any_spelling(tmp_path: Path, called: str) -> None:
    counts = counted(tmp_path, HOMES_HEADER + f"H,r,Kitchen,{called}:2\nH,s,bedroom,\n")
    rooms = counts.buildings["homes", "H"].rooms
    assert rooms["Kitchen"].things == {"Mug": 2}
    assert rooms["Bedroom"].rooms == 1, "an empty room of a home that somebody wrote down is one"


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (HOMES_HEADER + "H,r,kitchen,bed:x\n", r"line 2: the count of 'bed' is 'x'.*whole"),
        (HOMES_HEADER + "H,r,kitchen,bed:0\n", r"line 2: the count of 'bed' is 0"),
        (HOMES_HEADER + "H,r,kitchen,bed:-1\n", r"line 2: .*'-1'"),
        (HOMES_HEADER + "H,r,kitchen,bed:1.5\n", r"line 2: .*'1.5'"),
        (HOMES_HEADER + "H,r,kitchen,bed\n", r"line 2: objects has 'bed'; write name:count"),
        (HOMES_HEADER + "H,r,kitchen,bed:1||\n", r"line 2: objects has ''"),
        (HOMES_HEADER + "H,r,kitchen\n", r"line 2: 3 cells where the header has 4"),
        (HOMES_HEADER + "H,,kitchen,bed:1\n", r"line 2: building or room is empty"),
        (HOMES_HEADER + "H,r,kitchen,\nH,r,bedroom,\n", r"line 3: room 'r' of 'H' stands in .*2"),
        ("house,things\n", r"line 1: columns house,things are of no known shape"),
        ("", r"line 1: is empty"),
    ],
)
def test_bad_tables_are_refused_with_the_place_and_the_mend(
    tmp_path: Path, text: str, told: str
) -> None:
    with pytest.raises(KnowledgeError, match=rf"rooms_0.csv, {told}") as refused:
        counted(tmp_path, text)
    assert "\n" not in str(refused.value)


def test_the_header_tells_the_shape(tmp_path: Path) -> None:
    shapes = {HM3D: Shape.HM3D, MATTERPORT: Shape.MATTERPORT, HOMES_HEADER: Shape.HOMES}
    for text, shape in shapes.items():
        assert shape_of(write(tmp_path / "rooms.csv", text)) is shape


@pytest.mark.parametrize(
    ("row", "told"),
    [
        ("Bed,hm3d,mug", "hm3d 'mug' is Mug already"),
        ("Throne,hm3d,throne", "no table has a category 'Throne'"),
        ("Bed,ikea,bed", "source 'ikea' is none of: hm3d"),
    ],
)
def test_names_that_contradict_are_refused(tmp_path: Path, row: str, told: str) -> None:
    folder = tables(tmp_path, source_names=SOURCE_NAMES + row + "\n")
    with pytest.raises(KnowledgeError, match=rf"all.csv, line 15: {told}"):
        Names.load(folder)


def test_counts_are_read_as_they_were_written_and_the_same_bytes_again(tmp_path: Path) -> None:
    counts = counted(tmp_path, HM3D, MATTERPORT)
    write_counts(counts, tmp_path / "once")
    read = read_counts(tmp_path / "once")
    assert read == counts
    write_counts(read, tmp_path / "twice")
    for name in ("sources", "rooms", "pairs", "supports"):
        once, twice = (tmp_path / f / f"{name}.csv" for f in ("once", "twice"))
        assert once.read_bytes() == twice.read_bytes()


def test_of_many_buildings_rare_pairs_and_what_is_everywhere_are_not_kept(tmp_path: Path) -> None:
    text = HM3D.splitlines()[0] + "\n"
    for building in range(20):
        pillow = "|pillow:1" if building < 6 else ""
        mug = "|mug:1" if building < 5 else ""
        text += f"B{building},r,Bedroom,bed:1{pillow}{mug}\n"
        text += f"B{building},s,Bedroom,bed:1\n"
    counts = counted(tmp_path, text)
    write_counts(counts, tmp_path / "out")
    read = read_counts(tmp_path / "out")
    assert {p for b in read.buildings.values() for p in b.pairs} == {("Mug", "Pillow")}
    assert Figures(read).object_with_object("Mug", "Pillow").successes == 5
    of_common = Figures(read).object_with_object("Bed", "Pillow")
    assert (of_common.trials, of_common.p) == (0, Figures(read).base_rate("Bed"))


@pytest.mark.parametrize(
    ("name", "line", "told"),
    [
        ("rooms", "hm3d,9,Z,Bedroom,1,Bed:2:2", "rooms.csv, line .*'Bed:2:2' can't be"),
        ("rooms", "ikea,0,Z,Bedroom,1,Bed:1:1", "rooms.csv, line .*no source 'ikea'"),
        ("pairs", "hm3d,Bed,Pillow,7", "pairs.csv, line .*number 7; count again"),
        ("sources", "x,dreamt,room,1.0,,", "sources.csv, line .*'dreamt' is neither"),
        ("sources", "x,real,room,2,,", "sources.csv, line .*weight '2'"),
    ],
)
def test_spoilt_counts_are_refused(tmp_path: Path, name: str, line: str, told: str) -> None:
    write_counts(counted(tmp_path, HM3D), tmp_path / "out")
    path = tmp_path / "out" / f"{name}.csv"
    path.write_text(path.read_text() + line + "\n")
    with pytest.raises(KnowledgeError, match=told):
        read_counts(tmp_path / "out")


def test_simulated_homes_are_blocks_without_buildings(tmp_path: Path) -> None:
    bddl = "room_type,n_rooms,category,synset,rooms_with_category,total_instances\n"
    write(
        tmp_path / "bddl_room_category_counts.csv",
        bddl + "kitchen,5,mug,m,3,6\nkitchen,5,tea_mug,m,2,4\nspa,2,mug,m,1,1\n",
    )
    write(
        tmp_path / "bddl_cooccurrence_household.csv",
        "a,b,rooms_with_both,rooms_a,rooms_b\nmug,breakfast_table,6,8,20\n",
    )
    write(
        tmp_path / "procthor_receptacle_given.csv", "receptacle,object,count\nDiningTable,Mug,7\n"
    )
    write(
        tmp_path / "virtualhome_placing.csv",
        "object,relation,destination,room\nmug,ON,table,null\nmug,NEARBY,table,null\n",
    )
    counts, unknown = read_simulated(tmp_path, Names.load(tables(tmp_path / "tables")))
    kitchens = counts.buildings["bddl", ""].rooms["Kitchen"]
    assert (kitchens.rooms, kitchens.holding, kitchens.things) == (5, {"Mug": 3}, {"Mug": 10})
    assert counts.buildings["bddl_household", ""].pairs == {("Mug", "Table"): 6}
    assert counts.supports == {
        ("procthor", "Mug"): {"Table": 7},
        ("virtualhome", "Mug"): {"Table": 1},
    }
    assert unknown.rooms["bddl"] == {"spa": 2}
    assert not any(source.real for source in counts.sources.values())
