"""Laws of counting and of figures, for any homes."""

from __future__ import annotations

import tempfile
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from afkb.figures import Counts, Figures, Names, count_rooms, read_counts, write_counts
from figures_samples import tables, write

things = st.dictionaries(st.sampled_from(["bed", "pillow", "mug", "table"]), st.integers(1, 9))
rooms = st.tuples(st.sampled_from("ABCD"), st.sampled_from(["kitchen", "bedroom", "attic"]), things)
homes = st.lists(rooms, max_size=12)


def count(folder: Path, seen: list[tuple[str, str, dict[str, int]]], first: int = 0) -> Counts:
    text = "building,room,category,objects\n"
    for number, (building, category, objects) in enumerate(seen, first):
        cell = "|".join(f"{name}:{n}" for name, n in objects.items())
        text += f"{building},{number},{category},{cell}\n"
    path = write(folder / "homes.csv", text)
    return count_rooms([path], Names.load(tables(folder / "tables")))[0]


@settings(max_examples=40, deadline=None)
@given(homes, homes)
def test_adding_counts_is_counting_all(
    some: list[tuple[str, str, dict[str, int]]], others: list[tuple[str, str, dict[str, int]]]
) -> None:
    with tempfile.TemporaryDirectory() as folder:
        here = Path(folder)
        a, b = count(here, some), count(here, others, first=len(some))
        assert a.plus(b) == b.plus(a) == count(here, some + others)
        assert a.plus(Counts()) == a


@settings(max_examples=40, deadline=None)
@given(homes, st.sampled_from("ABCD"))
def test_leaving_a_building_out_is_not_counting_it(
    seen: list[tuple[str, str, dict[str, int]]], building: str
) -> None:
    with tempfile.TemporaryDirectory() as folder:
        counts = count(Path(folder), seen)
        if ("homes", building) not in counts.buildings:
            return
        others = count(Path(folder), [room for room in seen if room[0] != building])
        assert counts.without([building]).buildings == others.buildings


@settings(max_examples=40, deadline=None)
@given(homes)
def test_counts_come_back_as_they_were_written(
    seen: list[tuple[str, str, dict[str, int]]],
) -> None:
    with tempfile.TemporaryDirectory() as folder:
        counts = count(Path(folder), seen)
        write_counts(counts, Path(folder) / "out")
        assert read_counts(Path(folder) / "out") == counts


@settings(max_examples=40, deadline=None)
@given(homes)
def test_figures_are_probabilities_that_agree_with_their_counts(
    seen: list[tuple[str, str, dict[str, int]]],
) -> None:
    with tempfile.TemporaryDirectory() as folder:
        figures = Figures(count(Path(folder), seen))
        for found in figures.in_rooms():
            figure, number = found.figure, found.number
            assert 0 < figure.p < 1
            assert figure.successes <= figure.trials == number.rooms
            assert number.things >= figure.successes
            assert 1 <= figure.buildings <= figure.trials
        for pair in figures.together():
            back = figures.object_with_object(pair.given, pair.category).successes
            assert back == pytest.approx(pair.figure.successes)
