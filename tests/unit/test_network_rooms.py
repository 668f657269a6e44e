import math
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from afkb.errors import EvidenceError
from afkb.inference import Network
from afkb.inference.pgm import COUNT_STATES, ROOM, room_model
from afkb.inference.rooms import COUNT_BINS, bin_of
from afkb.knowledge import AfNet
from ontology_samples import Copy


@pytest.fixture(scope="module")
def network() -> Network:
    return Network.compile(AfNet())


def best(posterior: dict[str, float]) -> str:
    return max(posterior, key=posterior.__getitem__)


@pytest.mark.parametrize(
    ("counts", "room"),
    [
        ("SmallContainer 8 ClosedContainer 3 TableHeightSupport 1 CounterHeightSupport 1",
         "Kitchen"),
        ("CounterHeightSupport 1 TableHeightSupport 1 SmallContainer 2 ClosedContainer 1 "
         "SeatHeightSupport 4 HighSupport 1", "Kitchen"),
        ("CounterHeightSupport 2 SmallContainer 2", "Kitchen"),
        ("BedSupport 1", "Bedroom"),
        ("BedSupport 1 SideTableHeightSupport 2 HighSupport 1", "Bedroom"),
        ("SmallContainer 2 LargeContainer 2", "Bathroom"),
        ("LargeContainer 2", "Bathroom"),
        ("LargeContainer 2 SeatHeightSupport 1 ClosedContainer 1", "Bathroom"),
        ("TableHeightSupport 2 SeatHeightSupport 4 CouchHeightSupport 2", "LivingRoom"),
        ("CouchHeightSupport 2", "LivingRoom"),
        ("CouchHeightSupport 2 SeatHeightSupport 2 HighSupport 1", "LivingRoom"),
    ],
)  # fmt: skip
def test_rooms_are_told_by_what_they_afford(network: Network, counts: str, room: str) -> None:
    words = counts.split()
    evidence = {name: int(n) for name, n in zip(words[::2], words[1::2], strict=True)}
    posterior = network.room_posterior(evidence)
    assert best(posterior) == room
    assert math.fsum(posterior.values()) == pytest.approx(1, abs=1e-12)


def test_with_no_evidence_a_room_is_what_homes_have_most(network: Network) -> None:
    assert max(network.room_posterior({}).values()) < 0.35


def test_evidence_that_fits_no_room_is_unknown(network: Network) -> None:
    odd = {"BedSupport": 6, "LargeContainer": 9, "TableHeightSupport": 9}
    assert best(network.room_posterior(odd)) == "UnknownRoom"


def test_few_containers_and_many_tell_bathroom_from_kitchen(network: Network) -> None:
    few = network.room_posterior({"SmallContainer": 1, "LargeContainer": 2})
    many = network.room_posterior({"SmallContainer": 9, "LargeContainer": 2})
    assert few["Bathroom"] > few["Kitchen"]
    assert many["Kitchen"] > many["Bathroom"]


def test_looked_for_in_vain_differs_from_unobserved(network: Network) -> None:
    seen = network.room_posterior({"SideTableHeightSupport": 1})
    no_bed = network.room_posterior({"SideTableHeightSupport": 1, "BedSupport": 0})
    assert no_bed["Bedroom"] < seen["Bedroom"]


@pytest.mark.parametrize(
    ("counts", "message"),
    [
        ({"UnicornSupport": 1}, "'UnicornSupport' is no counted evidence class"),
        ({"BedSupport": -1}, "BedSupport has count -1"),
        ({"BedSupport": 1.5}, "BedSupport has count 1.5"),
        ({"BedSupport": math.nan}, "BedSupport has count nan"),
        ({"BedSupport": math.inf}, "BedSupport has count inf"),
    ],
)
def test_bad_counts_are_refused(network: Network, counts: dict[str, int], message: str) -> None:
    with pytest.raises(EvidenceError, match=message):
        network.room_posterior(counts)


def test_every_count_has_its_bin() -> None:
    assert [bin_of("any", n) for n in (0, 1, 2, 3, 4, 5, 8, 9, 5000)] == [0, 1, 2, 3, 3, 4, 4, 5, 5]


def test_tables_are_distributions(network: Network) -> None:
    for table in network.rooms.counts.values():
        assert table.shape[0] == len(COUNT_BINS)
        assert table.sum(axis=0) == pytest.approx(1.0)


CLASSES = ["BedSupport", "SeatHeightSupport", "TableHeightSupport", "SmallContainer"]


@pytest.fixture(scope="module")
def oracle(network: Network) -> object:
    from pgmpy.inference import VariableElimination

    return VariableElimination(room_model(network.rooms))


@settings(max_examples=12, deadline=None, derandomize=True)
@given(st.dictionaries(st.sampled_from(CLASSES), st.integers(0, 12)))
def test_closed_form_equals_variable_elimination(
    network: Network, oracle: object, counts: dict[str, int]
) -> None:
    evidence = {name: COUNT_STATES[bin_of(name, n)] for name, n in counts.items()}
    found = oracle.query([ROOM], evidence=evidence, show_progress=False)  # type: ignore[attr-defined]
    expected = {room: found.get_value(**{ROOM: room}) for room in network.rooms.rooms}
    assert network.room_posterior(counts) == pytest.approx(expected, abs=1e-9)


def test_deleting_a_room_statement_changes_the_posterior(tmp_path: Path, network: Network) -> None:
    changed = Network.compile(Copy().delete("Bedroom.BedSupport").load(tmp_path))
    counts = {"BedSupport": 1}
    assert changed.room_posterior(counts)["Bedroom"] < network.room_posterior(counts)["Bedroom"]


def test_halving_a_room_statement_changes_what_it_should_and_nothing_else(
    tmp_path: Path, network: Network
) -> None:
    half = Copy().set("Kitchen.SmallContainer", "expectedCount", 3.0).load(tmp_path)
    changed = Network.compile(half)
    many, bed = {"SmallContainer": 9}, {"BedSupport": 1}
    assert changed.room_posterior(many)["Kitchen"] < network.room_posterior(many)["Kitchen"]
    assert changed.room_posterior(bed) == network.room_posterior(bed)


def test_bif_holds_the_whole_network(tmp_path: Path, network: Network) -> None:
    from pgmpy.readwrite import BIFReader

    few = network.contents_network.among(["Sink", "Toilet", "Tap", "Bathtub"])
    network = replace(network)
    network.__dict__["contents_network"] = few  # Reading all 460 categories takes a minute.
    network.write_bif(tmp_path / "network.bif")
    model = BIFReader(str(tmp_path / "network.bif")).get_model()
    assert {"ObjectCategory", "ContainAbility", ROOM, "BedSupport"} <= set(model.nodes())
    table = model.get_cpds("BedSupport")
    value = table.get_value(
        BedSupport="from1to1",
        RoomCategory="Bedroom",
        ShareSeen=f"band{len(network.rooms.shares) - 1}",
    )
    room = network.rooms.rooms.index("Bedroom")
    assert value == pytest.approx(network.rooms.counts["BedSupport"][1, room, -1])
    assert model.get_cpds("ContainPredictsSupportBelowThere").get_value(
        ContainPredictsSupportBelowThere="yes", ContainPredictsSupportBelowSeen="yes"
    ) == pytest.approx(0.7)


def test_what_detectors_look_for_may_be_counted_as_absent(network: Network) -> None:
    looked_for = network.evidence_looked_for(["SupportAbility"])
    assert "BedSupport" in looked_for
    assert "SmallContainer" not in looked_for
    bare = network.room_posterior(dict.fromkeys(looked_for, 0))
    assert bare["Hallway"] > network.room_posterior({})["Hallway"]
    assert bare["LivingRoom"] < network.room_posterior({})["LivingRoom"]
