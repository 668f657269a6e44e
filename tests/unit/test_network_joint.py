"""Things of a room together: exact, and told by the ontology's figures of rooms and supports."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from afkb.errors import EvidenceError
from afkb.inference import SeenThing
from afkb.inference.network import Network
from afkb.inference.placement import PlacementNetwork
from afkb.inference.scene import leaves_first, recognise
from afkb.knowledge import AfNet

MUG = SeenThing({"ContainAbility": 0.9}, (0.1, 0.09, 0.1), 0.84)
BOOK = SeenThing({"StackAbility": 0.8}, (0.24, 0.17, 0.04), 0.79)
TABLE = SeenThing({"SupportAbility": 0.9}, (1.1, 0.7, 0.02), 0.74)
SHELF = SeenThing({"SupportAbility": 0.95}, (1.2, 0.4, 0.02), 0.95)


@pytest.fixture(scope="module")
def network() -> Network:
    return Network.compile(AfNet.load())


def probability(
    network: Network, things: list[SeenThing], i: int, name: str, **room: float
) -> float:
    shares = network.joint.recognise(things, room or None).shares[i]
    return float(shares[network.objects.categories.index(name)])


@dataclasses.dataclass(frozen=True)
class Case:
    """A random small network with evidence."""

    placement: PlacementNetwork
    prior: np.ndarray
    evidence: np.ndarray
    on: list[int | None]
    room: np.ndarray


@st.composite
def cases(draw: st.DrawFn) -> Case:
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    c, r, n, k = (int(rng.integers(2, high)) for high in (5, 4, 7, 4))
    in_room = rng.dirichlet(np.ones(c), size=r).T
    kind = rng.integers(0, k, size=c)
    placement = PlacementNetwork(("?",) * r, in_room, kind, rng.uniform(0.05, 4.0, (k, c)), {})
    order = rng.permutation(n)
    on: list[int | None] = [None] * n
    for place in range(1, n):
        if rng.random() < 0.7:
            on[int(order[place])] = int(order[rng.integers(place)])
    evidence = rng.uniform(0.0, 1.0, (n, c))
    return Case(placement, rng.dirichlet(np.ones(c)), evidence, on, rng.dirichlet(np.ones(r)))


def oracle(case: Case) -> tuple[np.ndarray, np.ndarray]:
    """Posteriors of things (N, C) and of the room (R,) by pgmpy's variable elimination."""
    from pgmpy.factors.discrete import TabularCPD
    from pgmpy.inference import VariableElimination
    from pgmpy.models import DiscreteBayesianNetwork

    model = DiscreteBayesianNetwork()
    rooms, (n, c) = len(case.room), case.evidence.shape
    tables = [TabularCPD("room", rooms, case.room[:, None])]
    model.add_node("room")
    table = case.placement.on[case.placement.kind]
    given_: dict[str, int] = {}
    for i in range(n):
        model.add_edges_from([("room", f"c{i}"), (f"c{i}", f"e{i}")])
        tables += [TabularCPD(f"c{i}", c, case.placement.in_room, ["room"], [rooms])]
        tables += [_yes(f"e{i}", case.evidence[i][None], [f"c{i}"], [c])]
        given_[f"e{i}"] = 1
    for i, carrier in enumerate(case.on):
        if carrier is not None:
            model.add_edges_from([(f"c{carrier}", f"on{i}"), (f"c{i}", f"on{i}")])
            fits = table.reshape(1, -1) / table.max()
            tables += [_yes(f"on{i}", fits, [f"c{carrier}", f"c{i}"], [c, c])]
            given_[f"on{i}"] = 1
    model.add_cpds(*tables)
    ask = VariableElimination(model)
    names = [f"c{i}" for i in range(n)]
    found = [ask.query([v], evidence=given_, show_progress=False).values for v in [*names, "room"]]
    return np.array(found[:-1]), found[-1]


def _yes(name: str, yes: np.ndarray, parents: list[str], cards: list[int]) -> object:
    from pgmpy.factors.discrete import TabularCPD

    return TabularCPD(name, 2, np.vstack([1.0 - yes, yes]), parents, cards)


def seen(case: Case) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    told = recognise(case.placement, case.prior, case.evidence, case.on, case.room)
    return told.shares, told.room, told.context


@settings(max_examples=4, deadline=None, derandomize=True)
@given(cases())
def test_messages_equal_variable_elimination(case: Case) -> None:
    shares, room, _ = seen(case)
    expected, expected_room = oracle(case)
    assert np.abs(shares - expected).max() < 1e-9
    assert np.abs(room - expected_room).max() < 1e-9


@settings(max_examples=15, deadline=None, derandomize=True)
@given(cases())
def test_context_is_what_the_thing_adds_to_the_evidence(case: Case) -> None:
    def weight(keep: list[int]) -> float:
        """P(all evidence of these things), by going through every assignment."""
        total = 0.0
        table = case.placement.on[case.placement.kind]
        shape = (case.evidence.shape[1],) * len(keep)
        for room, p in enumerate(case.room):
            for assigned in np.ndindex(*shape):
                of = dict(zip(keep, assigned, strict=True))
                product = p
                for i, category in of.items():
                    product *= case.placement.in_room[category, room] * case.evidence[i, category]
                    if case.on[i] in of:
                        product *= table[of[case.on[i]], category]  # type: ignore[index]
                total += product
        return total

    everything = list(range(min(len(case.on), 4)))
    on = [i if i is not None and i < 4 else None for i in case.on[:4]]
    small = dataclasses.replace(case, evidence=case.evidence[:4], on=on)
    without = weight([i for i in everything if i != everything[-1]])
    alone = float(small.evidence[everything[-1]] @ case.prior)
    context = seen(small)[2][-1]
    assert context == pytest.approx(weight(everything) / without / alone, rel=1e-9)


def test_a_mug_is_likelier_in_the_kitchen(network: Network) -> None:
    plate = SeenThing({"ContainAbility": 0.4}, (0.25, 0.25, 0.03), 0.9)
    assert probability(network, [plate], 0, "Plate", Kitchen=1.0) > 2 * probability(
        network, [plate], 0, "Plate", Bathroom=1.0
    )


def test_tables_and_books_raise_each_other(network: Network) -> None:
    apart = network.joint.recognise([TABLE, BOOK])
    together = network.joint.recognise([TABLE, dataclasses.replace(BOOK, on=0)])
    desk = network.objects.categories.index("Desk")
    assert together.shares[0, desk] > apart.shares[0, desk]


def test_a_table_under_ever_so_many_books_is_sure_and_finite(network: Network) -> None:
    books = [dataclasses.replace(BOOK, on=0, stands="Support")] * 600
    told = network.joint.recognise([TABLE, *books])
    assert np.isfinite(told.context).all()
    assert told.context[0] > 1e100


def test_a_board_over_another_is_a_shelfs(network: Network) -> None:
    one = probability(network, [SHELF], 0, "Shelf")
    assert probability(network, [dataclasses.replace(SHELF, boarded=True)], 0, "Shelf") > 3 * one


def test_things_stand_where_they_do(network: Network) -> None:
    bin_ = SeenThing({"ContainAbility": 0.9}, (0.3, 0.3, 0.4), 0.4)
    on_floor, on_table = (
        probability(network, [dataclasses.replace(bin_, stands=where)], 0, "TrashCan")
        for where in ("Floor", "Support")
    )
    assert on_floor > 2 * on_table


def test_nothing_seen_is_nothing_told(network: Network) -> None:
    told = network.joint.recognise([], {"Kitchen": 1.0})
    assert told.shares.shape == (0, len(network.objects.categories))
    assert told.room[network.joint.placement.rooms.index("Kitchen")] == 1.0


@pytest.mark.parametrize("on", [[0], [1, 0], [None, 2, 3, 1]])
def test_circles_are_refused(on: list[int | None]) -> None:
    with pytest.raises(EvidenceError, match="carry each other"):
        leaves_first(on)


@pytest.mark.parametrize(
    ("things", "room", "message"),
    [
        ([dataclasses.replace(MUG, on=7)], None, "stands on thing 7"),
        ([dataclasses.replace(MUG, stands="Moon")], None, "expected one of Floor"),
        ([MUG], {"Attic": 1.0}, "'Attic' is no room category"),
        ([MUG], {"Kitchen": 0.0}, "no distribution"),
    ],
)
def test_bad_input_is_named(
    network: Network, things: list[SeenThing], room: dict[str, float] | None, message: str
) -> None:
    with pytest.raises(EvidenceError, match=message):
        network.joint.recognise(things, room)


def test_impossible_evidence_is_an_error() -> None:
    placement = PlacementNetwork(
        ("Any",), np.array([[0.5], [0.5]]), np.zeros(2, int), np.ones((1, 2)), {}
    )
    with pytest.raises(EvidenceError, match="no category"):
        recognise(placement, np.full(2, 0.5), np.zeros((1, 2)), [None], np.ones(1))


@pytest.fixture(scope="module")
def without() -> dict[str, PlacementNetwork]:
    """The tables with one figure left out, and with one halved."""
    base = AfNet.load()
    prior = Network.compile(base).objects.prior

    class Changed:
        def __init__(self, **changes: object) -> None:
            self.changes = changes

        def __getattr__(self, name: str) -> object:
            return self.changes.get(name, getattr(base, name))

    in_rooms = {figure.name: figure for figure in base.objects_in_rooms}
    supports = {figure.name: figure for figure in base.objects_on_supports}
    room, put = in_rooms["Plate.Kitchen.InRoom"], supports["DiningTable.Mug.Support"]
    half = dataclasses.replace(room, mean_number=room.mean_number / 2)
    halved = dataclasses.replace(put, probability=put.probability / 2)
    changes: dict[str, dict[str, object]] = {
        "as stated": {},
        "no room": {"objects_in_rooms": [f for f in in_rooms.values() if f is not room]},
        "half a room": {"objects_in_rooms": (in_rooms | {room.name: half}).values()},
        "no support": {"objects_on_supports": [f for f in supports.values() if f is not put]},
        "half a support": {"objects_on_supports": (supports | {put.name: halved}).values()},
    }
    return {
        name: PlacementNetwork.compile(Changed(**change), prior)  # type: ignore[arg-type]
        for name, change in changes.items()
    }


def test_a_room_figure_changes_its_category_alone(without: dict[str, PlacementNetwork]) -> None:
    stated, base = without["as stated"], AfNet.load()
    names = list(base.categories)
    plate, kitchen = names.index("Plate"), stated.rooms.index("Kitchen")
    for change in ("half a room", "no room"):
        now = without[change]
        assert now.in_room[plate, kitchen] < 0.8 * stated.in_room[plate, kitchen]
        odds = now.in_room / stated.in_room
        alike = [i for i, name in enumerate(names) if "Plate" not in base.kinds_of(name)]
        assert np.ptp(odds[alike], axis=0).max() < 1e-9
        assert np.array_equal(now.on, stated.on)


def test_a_support_figure_changes_its_pair_most(without: dict[str, PlacementNetwork]) -> None:
    stated = without["as stated"]
    names = list(AfNet.load().categories)
    mug, table = names.index("Mug"), stated.kind[names.index("DiningTable")]
    before = stated.on[table, mug]
    assert before > without["half a support"].on[table, mug]
    for change in ("half a support", "no support"):
        assert without[change].on[table, mug] < 0.9 * before
        assert np.array_equal(without[change].in_room, stated.in_room)
