from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from afkb.errors import KnowledgeError
from afkb.figures import Counts, Figures, write_counts
from afkb.figures.counts import Source
from afkb.figures.smoothing import (
    beta_mean,
    dirichlet_means,
    gamma_mean,
    general_rate,
    odds_shifted,
)
from figures_samples import HM3D, MATTERPORT, counted

HOMES = "building,room,category,objects\nH,r,bedroom,bed:1|pillow:4\nI,r,bedroom,bed:1\n"
rates = st.floats(0.001, 0.999)
weights = st.floats(0.1, 100)
numbers = st.integers(0, 1000)


@pytest.fixture
def figures(tmp_path: Path) -> Figures:
    write_counts(counted(tmp_path, HM3D, MATTERPORT), tmp_path / "counts")
    return Figures.load(tmp_path / "counts")


def test_a_figure_tells_the_counts_behind_it(figures: Figures) -> None:
    figure = figures.object_in_room("Pillow", "Bedroom")
    assert (figure.successes, figure.trials, figure.buildings) == (2, 3, 2)
    assert figure.source == "hm3d"
    anywhere = general_rate(2, 4)
    assert figure.p == beta_mean(2, 3, anywhere, 8)
    together = figures.object_with_object("Pillow", "Bed")
    assert (together.successes, together.trials, together.buildings) == (2, 3, 2)
    number = figures.number_in_room("Bed", "Bedroom")
    assert (number.things, number.rooms) == (4, 3)


def test_viewpoints_answer_where_no_room_was_counted(figures: Figures) -> None:
    assert figures.object_in_room("Bed", "Bedroom").source == "hm3d"
    porch = figures.object_in_room("Bed", "Porch")
    assert porch.source == "matterport, about the rate of hm3d"
    assert porch.trials == pytest.approx(0.2)
    seen = figures.of("matterport")
    here, anywhere = seen.object_in_room("Bed", "Porch").p, seen.base_rate("Bed")
    assert porch.p == pytest.approx(odds_shifted(figures.base_rate("Bed"), here, anywhere))
    assert figures.number_in_room("Bed", "Porch").mean >= porch.p
    viewpoints = figures.of("matterport").object_in_room("Bed", "Bedroom")
    assert (viewpoints.source, viewpoints.trials) == ("matterport", pytest.approx(0.4))
    pooled = Figures(figures.counts, rooms_first=False).object_in_room("Bed", "Bedroom")
    assert (pooled.source, pooled.trials) == ("hm3d + matterport", pytest.approx(3.4))


def test_a_room_that_nobody_counted_has_the_rate_of_any_room(figures: Figures) -> None:
    figure = figures.object_in_room("Bed", "Garage")
    assert (figure.trials, figure.p) == (0, pytest.approx(figures.base_rate("Bed")))


def test_leaving_buildings_out_is_counting_without_them(figures: Figures, tmp_path: Path) -> None:
    rows = HM3D.splitlines(keepends=True)
    others = counted(tmp_path, "".join(r for r in rows if not r.startswith("A,")), MATTERPORT)
    assert figures.without(["A"]).counts.buildings == others.buildings
    assert list(figures.without(["A"]).in_rooms()) == list(Figures(others).in_rooms())
    with pytest.raises(KnowledgeError, match="no counts of building 'Z'"):
        figures.without(["Z"])


def test_adding_is_counting_together(figures: Figures, tmp_path: Path) -> None:
    own = Figures(counted(tmp_path, HOMES))
    together = counted(tmp_path, HM3D, MATTERPORT, HOMES)
    assert figures.plus(own).counts == together
    bed = figures.plus(own).object_in_room("Bed", "Bedroom")
    assert (bed.successes, bed.trials, bed.source) == (5, 5, "hm3d + homes")


def test_sources_of_one_name_and_different_units_are_not_added(figures: Figures) -> None:
    other = Counts({"hm3d": Source("hm3d", True, "viewpoint", 0.5, frozenset())})
    with pytest.raises(KnowledgeError, match="two sources are called 'hm3d'"):
        figures.plus(Figures(other))


def test_a_category_without_a_name_in_any_source_has_no_figure(figures: Figures) -> None:
    with pytest.raises(KnowledgeError, match=r"no counted source .* has a name for 'Throne'"):
        figures.object_in_room("Throne", "Bedroom")
    with pytest.raises(KnowledgeError, match="no counts tell what a Bed stands on"):
        figures.support_of("Bed")


def test_rooms_are_only_trials_for_what_their_source_has_a_name_of(tmp_path: Path) -> None:
    figures = Figures(counted(tmp_path, HM3D, HOMES.replace("pillow", "table")))
    assert figures.object_in_room("Table", "Bedroom").trials == 2, "hm3d has no name for tables"
    assert figures.object_with_object("Table", "Bed").trials == 2


def test_supports_sum_to_one_and_procthor_is_asked_first() -> None:
    sources = {n: Source(n, False, "thing", 1.0, frozenset()) for n in ("procthor", "virtualhome")}
    placed = {
        ("procthor", "Pen"): {"Desk": 6},
        ("procthor", "Mug"): {"Table": 6},
        ("virtualhome", "Pen"): {"Bed": 1},
        ("virtualhome", "Hat"): {"Bed": 1},
    }
    figures = Figures(Counts(sources, {}, placed))
    pen = figures.support_of("Pen")
    assert list(pen) == ["Desk", "Table"]
    assert sum(f.p for f in pen.values()) == pytest.approx(1)
    assert (pen["Desk"].p, pen["Desk"].successes, pen["Desk"].trials) == (0.8, 6, 6)
    assert figures.support_of("Hat")["Bed"].source == "virtualhome"
    assert [(s.thing, s.support) for s in figures.supports()] == [
        ("Hat", "Bed"),
        ("Mug", "Table"),
        ("Pen", "Desk"),
    ]


def test_iteration_yields_what_was_seen_and_no_more(figures: Figures) -> None:
    seen = {(f.category, f.room) for f in figures.in_rooms()}
    assert seen == {("Bed", "Bedroom"), ("Pillow", "Bedroom"), ("Mug", "Kitchen")}
    assert {f.room for f in figures.in_rooms(least=0.2)} == {"Bedroom", "Kitchen", "Porch"}
    assert {(t.category, t.given) for t in figures.together(least=2)} == {
        ("Bed", "Pillow"),
        ("Pillow", "Bed"),
    }


@given(numbers, numbers, rates, weights)
def test_a_smoothed_rate_lies_between_what_was_seen_and_the_prior(
    yes: int, no: int, prior: float, weight: float
) -> None:
    p = beta_mean(yes, yes + no, prior, weight)
    assert 0 < p < 1
    seen = yes / (yes + no) if yes + no else prior
    assert min(seen, prior) - 1e-9 <= p <= max(seen, prior) + 1e-9


@given(numbers, numbers, rates, weights)
def test_one_more_success_raises_the_rate_and_one_more_failure_lowers_it(
    yes: int, no: int, prior: float, weight: float
) -> None:
    p = beta_mean(yes, yes + no, prior, weight)
    assert beta_mean(yes + 1, yes + no + 1, prior, weight) > p
    assert beta_mean(yes, yes + no + 1, prior, weight) < p


@given(rates, rates, rates)
def test_an_odds_ratio_shifts_a_rate_towards_where_more_is_seen(
    rate: float, here: float, anywhere: float
) -> None:
    shifted = odds_shifted(rate, here, anywhere)
    assert 0 < shifted < 1
    assert (shifted > rate - 1e-9) if here >= anywhere else (shifted < rate + 1e-9)
    assert odds_shifted(shifted, anywhere, here) == pytest.approx(rate, rel=1e-6)


@given(numbers, st.integers(1, 1000), st.floats(0.01, 20), weights)
def test_a_smoothed_number_nears_the_seen_one_as_rooms_grow(
    things: int, rooms: int, prior: float, weight: float
) -> None:
    seen = things / rooms
    few, many = (gamma_mean(things * k, rooms * k, prior, weight) for k in (1, 100))
    assert few > 0
    assert abs(many - seen) <= abs(few - seen) + 1e-9


@given(st.dictionaries(st.sampled_from("abcdef"), st.integers(1, 99), min_size=1), weights)
def test_smoothed_shares_sum_to_one_and_leave_nothing_impossible(
    counts: dict[str, int], weight: float
) -> None:
    means = dirichlet_means(counts, dict.fromkeys("abcdef", 1 / 6), weight)
    assert sum(means.values()) == pytest.approx(1)
    assert min(means.values()) > 0
    unseen = set("abcdef") - set(counts)
    assert all(means[u] < means[c] for u in unseen for c in counts)
