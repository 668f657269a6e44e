import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from afkb.errors import EvidenceError
from afkb.inference import Network, network_of
from afkb.inference.contents import ContentsNetwork
from afkb.inference.holdings import Holdings, Stated, kinds_together
from afkb.inference.kinds import Kinds
from afkb.inference.numbers import NUMBER_STARTS
from afkb.inference.pgm import NUMBER_STATES, ROOM, SHARE, band_states, contents_model
from afkb.inference.rooms import RoomNetwork
from afkb.knowledge import AfNet, ObjectInRoom, ObjectWithObject
from ontology_samples import Copy

CATEGORIES = ("Bed", "Cup", "Kettle", "Pillow", "Stove")
ROOMS = ("Bedroom", "Kitchen", "UnknownRoom")


@pytest.fixture(scope="module")
def network() -> Network:
    return network_of(AfNet())


def in_room(category: str, room: str, p: float, number: float = 1.0) -> ObjectInRoom:
    return ObjectInRoom(
        f"{category}.{room}.InRoom", "", "", "", "", "", category, p, 0.0, 50.0, room, p * number
    )


def together(category: str, given: str, p: float) -> ObjectWithObject:
    return ObjectWithObject(
        f"{category}.{given}.Together", "", "", "", "", "", category, p, 0.0, 50.0, given
    )


def small(seed: int) -> Stated:
    """A random little ontology's statements."""
    random = np.random.default_rng(seed)
    pairs = [(a, b) for a in CATEGORIES for b in CATEGORIES if a != b]
    chosen = [pairs[i] for i in random.permutation(len(pairs))[:8]]
    return Stated(
        rooms={room: random.uniform(0.5, 3) for room in ROOMS},
        categories=dict.fromkeys(CATEGORIES, 0.5),
        in_rooms=tuple(
            in_room(c, r, random.uniform(0.02, 0.9), random.uniform(1, 4))
            for c in CATEGORIES
            for r in ROOMS[:2]
            if random.random() < 0.8
        ),
        together=tuple(together(a, b, random.uniform(0.1, 0.95)) for a, b in chosen),
        shares=(0.25, 0.5, 0.9),
        stray=0.1,
    )


class Oracle:
    """pgmpy's variable elimination on the same network."""

    def __init__(self, network: ContentsNetwork) -> None:
        from pgmpy.inference import VariableElimination

        self.network, self.inference = network, VariableElimination(contents_model(network))

    def ask(self, node: str, state: str, evidence: dict[str, str]) -> float:
        answer = self.inference.query([node], evidence=evidence, show_progress=False)
        return float(answer.get_value(**{node: state}))

    @staticmethod
    def told(found: dict[str, int]) -> dict[str, str]:
        evidence = {}
        for category, n in found.items():
            evidence[f"{category}InRoom"] = "yes" if n else "no"
            evidence[f"{category}Number"] = NUMBER_STATES[sum(n >= s for s in NUMBER_STARTS)]
        return evidence


@settings(max_examples=8, deadline=None, derandomize=True)
@given(st.integers(0, 10_000), st.lists(st.integers(0, 10), min_size=5, max_size=5))
def test_closed_forms_equal_variable_elimination_on_random_networks(
    seed: int, numbers: list[int]
) -> None:
    network = ContentsNetwork.compile(small(seed))
    found = dict(zip(CATEGORIES, numbers, strict=True))
    oracle, told = Oracle(network), Oracle.told(found)
    weights = network.prior[:, None] * network.likelihood(found)
    by_room = weights.sum(axis=1) / weights.sum()
    even = np.repeat(network.prior[:, None] / 3, 3, axis=1)
    hidden = network.each_hidden(found, even)
    for i, room in enumerate(network.rooms):
        assert by_room[i] == pytest.approx(oracle.ask(ROOM, room, told), abs=1e-9)
    for category in CATEGORIES:
        rest = Oracle.told({c: n for c, n in found.items() if c != category})
        expected = oracle.ask(f"{category}InRoom", "yes", rest)
        assert hidden[category] == pytest.approx(expected, abs=1e-9)


@settings(max_examples=5, deadline=None, derandomize=True)
@given(st.integers(0, 10_000), st.sets(st.sampled_from(CATEGORIES), max_size=3))
def test_what_nobody_looked_for_is_unobserved(seed: int, seen: set[str]) -> None:
    network = ContentsNetwork.compile(small(seed))
    found = dict.fromkeys(sorted(seen), 2)
    even = np.repeat(network.prior[:, None] / 3, 3, axis=1)
    beside = network.beside(found, even)
    for category in sorted(set(CATEGORIES) - seen):
        oracle = Oracle(network.among([*found, category]))
        expected = oracle.ask(f"{category}InRoom", "yes", Oracle.told(found))
        assert beside[category] == pytest.approx(expected, abs=1e-9)


def test_weights_are_what_else_is_known_of_room_and_share() -> None:
    network = ContentsNetwork.compile(small(1))
    weights = np.zeros((3, 3))
    weights[1, 2] = 1.0
    oracle = Oracle(network)
    known = {ROOM: network.rooms[1], SHARE: band_states(3)[2]}
    hidden = network.each_hidden({"Cup": 1}, weights)
    told = Oracle.told({c: int(c == "Cup") for c in CATEGORIES if c != "Kettle"})
    expected = oracle.ask("KettleInRoom", "yes", known | told)
    assert hidden["Kettle"] == pytest.approx(expected, abs=1e-9)


def test_a_room_of_which_nothing_is_known_holds_what_is_stated() -> None:
    stated = replace(small(3), stray=0.0, together=())
    network = ContentsNetwork.compile(stated)
    for figure in stated.in_rooms:
        alone = np.zeros((3, 3))
        alone[network.rooms.index(figure.room)] = 1 / 3
        told = network.beside({}, alone)[figure.category]
        assert told == pytest.approx(figure.probability, abs=1e-6)


def test_what_is_met_together_raises_each_other_and_nothing_else() -> None:
    stated = replace(small(4), together=())
    paired = replace(stated, together=(together("Kettle", "Stove", 0.95),))
    before, after = (ContentsNetwork.compile(s) for s in (stated, paired))
    even = np.full((3, 3), 1 / 9)
    for seen, other in (("Kettle", "Stove"), ("Stove", "Kettle")):
        apart, near = (n.beside({seen: 1}, even) for n in (before, after))
        assert near[other] > apart[other]
        for category in ("Bed", "Cup", "Pillow"):
            assert near[category] == pytest.approx(apart[category], abs=0.02)


def touching(kb: AfNet, category: str) -> set[str]:
    """The category and those that it is stated to be met with."""
    pairs = [{f.category, f.given} for f in kb.objects_with_objects]
    return {category}.union(*(pair for pair in pairs if category in pair))


def test_halving_a_figure_of_a_room_changes_its_category_there(
    tmp_path: Path, network: Network
) -> None:
    figure = next(f for f in network.knowledge_base.objects_in_rooms
                  if (f.category, f.room) == ("Stove", "Kitchen"))  # fmt: skip
    halved = Copy().set(figure.name, "probability", figure.probability / 2).load(tmp_path)
    changed, was = Network.compile(halved).contents_network, network.contents_network
    kitchen, stove = was.rooms.index("Kitchen"), was.at("Stove")
    met_with = touching(network.knowledge_base, "Stove")
    assert changed.hazard[stove, kitchen] < 0.7 * was.hazard[stove, kitchen]
    others = [i for i, c in enumerate(was.categories) if c not in met_with]
    assert len(others) > 300
    assert np.array_equal(changed.hazard[others], was.hazard[others])
    assert np.array_equal(changed.by_room[others], was.by_room[others])
    kept = [c for c in was.causes if stove not in (c.source, c.effect)]
    assert [c for c in changed.causes if stove not in (c.source, c.effect)] == kept


def test_deleting_what_is_together_leaves_all_but_its_effect(
    tmp_path: Path, network: Network
) -> None:
    was = network.contents_network
    cause = max(was.causes, key=lambda c: c.hazard)
    copy = Copy()
    for name in cause.statements:
        copy.delete(name)
    changed = Network.compile(copy.load(tmp_path)).contents_network
    gone = {(c.source, c.effect) for c in was.causes} - {
        (c.source, c.effect) for c in changed.causes
    }
    assert gone == {(cause.source, cause.effect)}
    others = [i for i in range(len(was.categories)) if i != cause.effect]
    assert np.array_equal(changed.by_room[others], was.by_room[others])


def test_rooms_by_recognised_things(network: Network) -> None:
    prior = network.room_posterior({})
    bed = network.room_posterior({}, {"Bed": 1})
    assert bed["Bedroom"] > 2 * prior["Bedroom"]
    assert math.fsum(bed.values()) == pytest.approx(1, abs=1e-12)
    no_bed = network.room_posterior({}, {"Bed": 0})
    assert no_bed["Bedroom"] < prior["Bedroom"]
    assert network.room_posterior({}, {}) == pytest.approx(prior, abs=1e-12)


def test_contents_follow_the_room_and_what_was_seen(network: Network) -> None:
    kitchen, bedroom = (network.contents({room: 1.0}) for room in ("Kitchen", "Bedroom"))
    assert kitchen["Stove"] > 5 * bedroom["Stove"]
    assert bedroom["Pillow"] > 3 * kitchen["Pillow"]
    assert (
        network.contents({"Bathroom": 1.0}, {"Sink": 1})["Tap"]
        > (network.contents({"Bathroom": 1.0})["Tap"])
    )
    assert set(kitchen) == set(network.knowledge_base.categories)
    assert all(0 < p < 1 for p in kitchen.values())


@pytest.mark.parametrize(
    ("ask", "said"),
    [
        (lambda n: n.room_posterior({}, {"Unicorn": 1}), "'Unicorn' is no object category"),
        (lambda n: n.room_posterior({}, {"Bed": -1}), "-1 of Bed; expected a whole number"),
        (lambda n: n.room_posterior({}, {"Bed": math.nan}), "nan of Bed; expected a whole"),
        (lambda n: n.contents({"Moon": 1.0}), "no belief over the rooms"),
        (lambda n: n.contents({"Kitchen": 0.0}), "no belief over the rooms"),
    ],
)  # fmt: skip
def test_bad_evidence_is_told(network: Network, ask: object, said: str) -> None:
    with pytest.raises(EvidenceError, match=said):
        ask(network)  # type: ignore[operator]


def test_evidence_that_no_room_can_give_is_an_error() -> None:
    never = np.zeros((6, 2, 1))
    never[0] = 1.0
    rooms = RoomNetwork(("Kitchen", "UnknownRoom"), np.array([0.5, 0.5]), (1.0,), {"Bed": never})
    assert rooms.posterior({"Bed": 0})["Kitchen"] == pytest.approx(0.5)
    with pytest.raises(EvidenceError, match=r"no room category can hold \{'Bed': 2\}"):
        rooms.posterior({"Bed": 2})


def test_a_crowded_room_and_contradictions_have_an_answer(network: Network) -> None:
    crowd = dict.fromkeys(network.knowledge_base.categories, 5)
    posterior = network.room_posterior({"BedSupport": 9}, crowd)
    assert math.fsum(posterior.values()) == pytest.approx(1)
    assert all(math.isfinite(p) for p in network.contents(posterior, crowd).values())


def test_kinds_are_known_by_what_they_afford(network: Network) -> None:
    kb = network.knowledge_base
    kinds, structural = Kinds(kb).of, Kinds(kb, with_material=False).of
    assert kinds["DiningTable"] != kinds["Bed"]
    assert "SupportAbility" in structural["DiningTable"]
    assert len(set(structural.values())) < len(set(kinds.values())) < len(kinds)
    holdings = Holdings.compile(Stated.of(kb))
    grouped = kinds_together(holdings, [kinds[c] for c in holdings.categories])
    bed, kind = holdings.categories.index("Bed"), grouped.categories.index(kinds["Bed"])
    assert (grouped.probability[kind] >= holdings.probability[bed] - 1e-12).all()
