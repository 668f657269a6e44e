import dataclasses
import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from afkb.errors import EvidenceError
from afkb.inference import Network
from afkb.inference.object_tables import LENGTH, WIDTH
from afkb.inference.pgm import CATEGORY, NO_YES, band_states, object_model
from afkb.knowledge import AfNet
from ontology_samples import Copy, extension

TABLES = {"Table", "KitchenTable", "Desk"}
Size = tuple[float, float, float]


@pytest.fixture(scope="module")
def network() -> Network:
    return Network.compile(AfNet())


def best(posterior: dict[str, float]) -> str:
    return max(posterior, key=posterior.__getitem__)


@pytest.mark.parametrize(
    ("affordance", "size", "top", "expected"),
    [
        ("SupportAbility", (1.2, 0.8, 0.73), 0.73, TABLES),
        ("SupportAbility", (0.45, 0.45, 0.05), 0.45, {"Chair", "Stool"}),
        ("SupportAbility", (2.0, 1.5, 0.5), 0.5, {"Bed"}),
        ("SupportAbility", (2.0, 0.6, 0.02), 0.93, {"Counter"}),
        ("SupportAbility", (2.1, 0.6, 0.1), 0.44, {"Couch"}),
        ("SupportAbility", (0.8, 0.25, 0.02), 1.4, {"Shelf", "WallShelf"}),
        ("ContainAbility", (0.11, 0.11, 0.09), 0.82, {"Mug", "Cup"}),
        ("ContainAbility", (0.18, 0.18, 0.08), 0.82, {"Bowl"}),
        ("ContainAbility", (0.4, 0.35, 0.55), 0.55, {"TrashCan"}),
        ("IntrinsicContainAbility", (0.08, 0.08, 0.26), 1.0, {"Bottle"}),
        ("BlockAbility", (3.0, 0.1, 2.5), 2.5, {"Wall"}),
        ("EngraveAbility", (0.15, 0.01, 0.01), 0.75, {"Pen", "Marker", "Pencil"}),
    ],
)
def test_things_are_told_by_affordance_size_and_height(
    network: Network, affordance: str, size: Size, top: float, expected: set[str]
) -> None:
    posterior = network.category_posterior({affordance: 0.9}, size, top)
    assert best(posterior) in expected
    assert math.fsum(posterior.values()) == pytest.approx(1, abs=1e-12)


def test_what_fits_nothing_is_something_else(network: Network) -> None:
    trough = network.category_posterior({"ContainAbility": 0.95}, (2.4, 0.12, 0.1), 0.5)
    assert best(trough) == "SomethingElse"


def test_a_mug_is_dynamic_and_a_table_static(network: Network) -> None:
    mug = network.category_posterior({"ContainAbility": 0.9}, (0.08, 0.08, 0.09), 0.82)
    kind, weight = network.movability(mug)
    assert (kind, weight) == ("Dynamic", pytest.approx(0.3, abs=0.02))
    table = network.category_posterior({"SupportAbility": 0.9}, (1.2, 0.8, 0.02), 0.73)
    assert network.movability(table) == ("Static", pytest.approx(1.0, abs=0.06))


def test_movability_of_what_nothing_is_known_about(network: Network) -> None:
    assert network.movability({"SomethingElse": 1.0}) == ("Static", pytest.approx(0.5))
    with pytest.raises(EvidenceError, match="'Unicorn' is no object category"):
        network.movability({"Unicorn": 1.0})


def test_unobserved_is_not_absent(network: Network) -> None:
    size, top = (0.08, 0.08, 0.09), 0.82
    silent = network.category_posterior({"ContainAbility": 0.9}, size, top)
    undecided = {"ContainAbility": 0.9, "IntrinsicContainAbility": 0.5}
    assert network.category_posterior(undecided, size, top) == pytest.approx(silent)
    absent = {"ContainAbility": 0.0}
    assert network.category_posterior(absent, size, top)["Mug"] < 0.2 * silent["Mug"]


def test_more_certain_evidence_moves_the_posterior_further(network: Network) -> None:
    size, top = (0.09, 0.08, 0.09), 0.82
    mugs = [
        network.category_posterior({"ContainAbility": p}, size, top)["Mug"]
        for p in (0.0, 0.3, 0.5, 0.7, 1.0)
    ]
    assert mugs == sorted(mugs)


def test_a_closed_package_is_no_open_one_though_it_contains(network: Network) -> None:
    size, top = (0.07, 0.07, 0.11), 0.85
    closed = {"ContainAbility": 0.9, "IntrinsicContainAbility": 0.9}
    only = network.category_posterior({"IntrinsicContainAbility": 0.9}, size, top)
    assert network.category_posterior(closed, size, top) == pytest.approx(only)
    assert network.evidence_of(closed, size, top) == ("ClosedContainer",)


@pytest.mark.parametrize(
    ("affordances", "size", "top", "message"),
    [
        ({"HoverAbility": 0.9}, (1, 1, 1), 0.5, "'HoverAbility' is no feature"),
        ({"SupportAbility": 1.5}, (1, 1, 1), 0.5, "SupportAbility has probability 1.5"),
        ({"SupportAbility": math.nan}, (1, 1, 1), 0.5, "SupportAbility has probability nan"),
        ({}, (1, -1, 1), 0.5, "expected three finite extents"),
        ({}, (1, math.inf, 1), 0.5, "expected three finite extents"),
        ({}, (1, 1, 1), math.nan, "top height nan"),
    ],
)
def test_bad_evidence_is_refused(
    network: Network, affordances: dict[str, float], size: Size, top: float, message: str
) -> None:
    with pytest.raises(EvidenceError, match=message):
        network.category_posterior(affordances, size, top)


def test_evidence_of_probability_zero_is_an_error(network: Network) -> None:
    impossible = {"SupportAbility": np.zeros(len(network.objects.categories))}
    changed = dataclasses.replace(network.objects, features=impossible)
    with pytest.raises(EvidenceError, match="no category can afford"):
        changed.posterior({"SupportAbility": 1.0}, (0.1, 0.1, 0.1), 0.5)


PROBABILITIES = st.floats(0, 1)
FEATURES = st.dictionaries(
    st.sampled_from(
        ["SupportAbility", "ContainAbility", "IntrinsicContainAbility", "BlockAbility"]
    ),
    PROBABILITIES,
)


@pytest.fixture(scope="module")
def oracle(network: Network) -> object:
    from pgmpy.inference import VariableElimination

    return VariableElimination(object_model(network.objects))


@settings(max_examples=12, deadline=None, derandomize=True)
@given(FEATURES, st.tuples(*[st.floats(0.0, 3.0)] * 3), st.floats(-0.1, 2.5), st.booleans())
def test_closed_form_equals_variable_elimination(
    network: Network,
    oracle: object,
    affordances: dict[str, float],
    size: Size,
    top: float,
    whole: bool,
) -> None:
    from pgmpy.factors.discrete import TabularCPD

    likelihoods, bands = network.objects.observed(affordances, size, top)
    virtual = [
        TabularCPD(name, 2, [[1 - p], [p]], state_names={name: NO_YES})
        for name, p in likelihoods.items()
    ]
    states = {n: band_states(len(network.objects.measures[n])) for n in bands}
    at_least = {n: b for n, b in bands.items() if n in (LENGTH, WIDTH) and not whole}
    virtual += [
        TabularCPD(
            n,
            len(states[n]),
            [[float(k >= b)] for k in range(len(states[n]))],
            state_names={n: states[n]},
        )
        for n, b in at_least.items()
    ]
    evidence = {n: states[n][b] for n, b in bands.items() if n not in at_least}
    found = oracle.query(  # type: ignore[attr-defined]
        [CATEGORY], evidence=evidence, virtual_evidence=virtual or None, show_progress=False
    )
    expected = {name: found.get_value(**{CATEGORY: name}) for name in network.objects.categories}
    posterior = network.category_posterior(affordances, size, top, whole)
    assert posterior == pytest.approx(expected, abs=1e-9)


def test_what_is_not_seen_whole_may_be_larger(network: Network) -> None:
    size, top = (0.3, 0.3, 0.02), 0.74
    part = network.category_posterior({"SupportAbility": 0.95}, size, top, whole=False)
    whole = network.category_posterior({"SupportAbility": 0.95}, size, top)
    tables = [n for n in part if "Table" in network.knowledge_base.kinds_of(n)]
    assert sum(part[n] for n in tables) > 2 * sum(whole[n] for n in tables)


def test_a_weaker_afbit_lowers_its_category_and_no_other_order(tmp_path: Path) -> None:
    size, top = (0.09, 0.08, 0.09), 0.82
    before = Network.compile(AfNet())
    changed = Network.compile(
        Copy().set("Mug.BasinPart.ContainAbility", "strength", 0.2).load(tmp_path)
    )
    old = before.category_posterior({"ContainAbility": 0.9}, size, top)
    new = changed.category_posterior({"ContainAbility": 0.9}, size, top)
    assert new["Mug"] < 0.5 * old["Mug"]
    assert new["Cup"] / new["Bowl"] == pytest.approx(old["Cup"] / old["Bowl"])


def test_an_extension_category_is_recognised_and_inherits_afbits(tmp_path: Path) -> None:
    body = """
    <afn:ObjectCategory rdf:about="https://example.org/home#Cauldron">
     <skos:broader rdf:resource="https://w3id.org/afkb/afnet#Pot"/>
     <afn:scale rdf:resource="https://w3id.org/afkb/afnet#Medium"/>
     <afn:movability rdf:resource="https://w3id.org/afkb/afnet#Static"/>
     <afn:matchingWeight>0.8</afn:matchingWeight><afn:expectedNumber>1</afn:expectedNumber>
     <afn:lengthMin>0.8</afn:lengthMin><afn:lengthMax>0.9</afn:lengthMax>
     <afn:widthMin>0.8</afn:widthMin><afn:widthMax>0.9</afn:widthMax>
     <afn:heightMin>0.7</afn:heightMin><afn:heightMax>0.8</afn:heightMax>
     <afn:topMin>0.7</afn:topMin><afn:topMax>0.9</afn:topMax>
    </afn:ObjectCategory>"""
    network = Network.compile(AfNet(extensions=[extension(tmp_path, body)]))
    posterior = network.category_posterior({"ContainAbility": 0.9}, (0.85, 0.85, 0.75), 0.8)
    assert best(posterior) == "Cauldron"


def test_affordances_that_the_ontology_lacks_can_be_left_out(network: Network) -> None:
    reported = {"HoverAbility": 0.9, "ContainAbility": 0.8}
    assert network.known(reported) == {"ContainAbility": 0.8}
