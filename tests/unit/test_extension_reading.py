"""What an extension says is what the knowledge base knows."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from rdflib import Graph, URIRef
from rdflib.namespace import OWL, RDF, RDFS

from afkb.extensions import extension_graph, extension_homes
from afkb.extensions.problems import Problems
from afkb.extensions.yaml_rows import yaml_sheet
from afkb.inference import Network
from afkb.knowledge import AFN, SOMETHING_ELSE, AfNet
from extension_samples import KIOSK, table, yaml_file

HOME = "https://example.org/home#"
EVERYTHING = """\
iri: https://home.example/words#
label: words of a home
source: our own measurements
categories:
  Kiosk:
    label: snack kiosk
    definition: A small stall indoors.
    example: the stall in the hall
    broader: Stall
    length_m: [0.4, 0.8]
    width_m: [0.3, 0.5]
    height_m: [1.0, 1.5]
    top_m: [0.9, 1.0]
    mass_kg: [20, 60]
    scale: Large
    stands_on: Floor
    moved: Fixed
    matching_weight: 0.7
    expected_number: 0.2
    afbits: [StallAbility = 0.8, "/CounterPart > SupportAbility @ UprightPose = 0.9"]
  Stall: {broader: Trade, length_m: [1, 2], width_m: [1, 1], height_m: [2, 3]}
groups:
  Trade: {definition: What things are sold at.}
parts:
  CounterPart: {definition: Where things are handed over.}
features:
  StallAbility:
    kind: structural
    definition: Ability to sell from it.
    grounding: a counter below a roof
    parameters: {height_m: [1, 2, 2.5, 3]}
duals:
  StallPredictsContainOn:
    evidence: StallAbility
    predicted: ContainAbility
    relation: on
    strength: 0.6
    distance_m: [0.1, 0.2]
    size_m: [0.1, 0.2]
    evidence_bottom_m: 0.1
co_occurrences:
  KioskSuggestsTable: {feature: SupportAbility, evidence_category: Kiosk,
    predicted_category: Table, strength: 0.3, size_m: [1.2, 0.8], distance_m: [2, 1]}
evidence_classes:
  StallCounter: {feature: StallAbility, length_m: [1, null], top_m: [0.9, 1.1]}
rooms:
  Shop: {definition: A room to sell in., expected_number: 0.1, holds: {StallCounter: 1.5}}
parameters:
  Haggling: 0.4
"""


@pytest.fixture(scope="module")
def home(tmp_path_factory: pytest.TempPathFactory) -> AfNet:
    folder = tmp_path_factory.mktemp("home")
    return AfNet(extensions=[yaml_file(folder, EVERYTHING)])


def test_a_category_says_what_its_file_says(home: AfNet) -> None:
    kiosk = home.categories["Kiosk"]
    assert kiosk.iri == "https://home.example/words#Kiosk"
    assert (kiosk.label, kiosk.definition) == ("snack kiosk", "A small stall indoors.")
    assert (kiosk.status, kiosk.source) == ("proposed", "our own measurements")
    assert kiosk.length_m == (0.4, 0.8) and kiosk.mass_kg == (20, 60)
    assert kiosk.top_height_m == (0.9, 1.0)
    assert (kiosk.scale, kiosk.stands_on, kiosk.moved) == ("Large", "Floor", "Fixed")
    assert (kiosk.movability, kiosk.matching_weight) == ("Static", 0.7)
    assert (kiosk.broader, kiosk.expected_number) == ("Stall", 0.2)
    assert kiosk.afbits["StallAbility"] == 0.8


def test_an_afbit_of_a_part_keeps_its_part_and_pose(home: AfNet) -> None:
    (found,) = [a for a in home.afbits if a.category == "Kiosk" and a.part == "CounterPart"]
    assert (found.feature, found.pose, found.strength) == ("SupportAbility", "UprightPose", 0.9)


def test_an_affordance_has_its_grounding(home: AfNet) -> None:
    feature = home.features["StallAbility"]
    assert (feature.kind, feature.grounding) == ("structural", "a counter below a roof")
    assert feature.parameters["height_m"](2.2) == 1.0


def test_relationships_and_rooms_are_there(home: AfNet) -> None:
    dual = next(d for d in home.duals if d.name == "StallPredictsContainOn")
    assert (dual.evidence, dual.relation, dual.strength) == ("StallAbility", "on", 0.6)
    assert (dual.distance_m, dual.size_xy_m) == ((0.1, 0.2), (0.1, 0.2))
    assert (dual.evidence_bottom_min_m, dual.predicted_scale) == (0.1, "Small")
    pair = next(c for c in home.co_occurrences if c.name == "KioskSuggestsTable")
    assert (pair.evidence_category, pair.predicted_category) == ("Kiosk", "Table")
    assert home.evidence_classes["StallCounter"].length_m[0] == 1
    assert home.rooms["Shop"].expected_counts == {"StallCounter": 1.5}
    assert home.rooms["Kitchen"].expected_counts["StallCounter"] == 0.05
    assert home.parameters["Haggling"] == 0.4


def test_the_network_takes_it_all_in(home: AfNet) -> None:
    network = Network.compile(home)
    belief = network.category_posterior({"StallAbility": 0.99}, (0.6, 0.4, 1.2), 0.95)
    listed = {name: p for name, p in belief.items() if name != SOMETHING_ELSE}
    assert max(listed, key=listed.__getitem__) == "Kiosk"
    before, after = (network.room_posterior(c)["Shop"] for c in ({}, {"StallCounter": 2}))
    assert after > 10 * before


def test_what_is_left_out_follows_from_what_is_said(tmp_path: Path) -> None:
    kiosk = AfNet(extensions=[yaml_file(tmp_path, KIOSK)]).categories["Kiosk"]
    assert (kiosk.label, kiosk.scale, kiosk.moved) == ("kiosk", "Large", "RarelyMoved")
    assert (kiosk.matching_weight, kiosk.expected_number) == (0.8, 1.0)
    assert (kiosk.status, kiosk.source) == ("proposed", "home.yaml")
    assert kiosk.iri == f"{HOME}Kiosk"


def test_what_stands_on_the_floor_has_its_top_at_its_height(tmp_path: Path) -> None:
    path = yaml_file(tmp_path, KIOSK + "    stands_on: Floor\n")
    assert AfNet(extensions=[path]).categories["Kiosk"].top_height_m == (1.0, 1.5)


def test_what_is_small_is_carried(tmp_path: Path) -> None:
    body = KIOSK.replace("0.4, 0.8", "0.1, 0.2").replace("1.0, 1.5", "0.1, 0.2")
    kiosk = AfNet(extensions=[yaml_file(tmp_path, body.replace("0.3, 0.5", "0.1, 0.1"))])
    assert kiosk.categories["Kiosk"].moved == "Carried"


RULED = KIOSK + "    shape: CylinderShape\n    traits: [OpenTop]\n    mass_kg: [0.1, 0.5]\n"


def test_rules_make_its_afbits_and_say_so(tmp_path: Path) -> None:
    base = AfNet(extensions=[yaml_file(tmp_path, RULED)])
    (contains,) = [a for a in base.afbits if a.category == "Kiosk" and "Contain" in a.feature]
    assert contains.rules and contains.status == "proposed"
    assert "rules/structural.csv, line" in contains.source
    assert "trait:OpenTop (home.yaml, line 3)" in contains.source
    assert contains.place.endswith("home.yaml, line 3")


def test_a_handle_gets_its_grasps(tmp_path: Path) -> None:
    body = KIOSK.replace("0.4, 0.8", "0.1, 0.2").replace("0.3, 0.5", "0.1, 0.2")
    body = body.replace("1.0, 1.5", "0.1, 0.2") + "    mass_kg: [0.2, 0.5]\n"
    base = AfNet(extensions=[yaml_file(tmp_path, body + "    traits: [GripHandle]\n")])
    grasps = {
        afbit.feature
        for afbit in base.afbits
        if afbit.category == "Kiosk" and base.features[afbit.feature].kind == "grasp"
    }
    assert grasps


@pytest.mark.parametrize("strength", [0.3, 0.0])
def test_own_afbits_take_precedence(tmp_path: Path, strength: float) -> None:
    body = RULED + f"    afbits: [ContainAbility = {strength}]\n"
    kiosk = AfNet(extensions=[yaml_file(tmp_path, body)]).categories["Kiosk"]
    assert kiosk.afbits.get("ContainAbility", 0.0) == strength


def test_more_afbits_of_a_bundled_category(tmp_path: Path) -> None:
    path = yaml_file(tmp_path, "afbits:\n  - Mug > StallAbility = 0.6\n" + FEATURE)
    base = AfNet(extensions=[path])
    assert base.categories["Mug"].afbits["StallAbility"] == 0.6
    assert base.categories["Mug"].afbits.items() > AfNet().categories["Mug"].afbits.items()


FEATURE = "features:\n  StallAbility: {kind: structural, definition: Ability to sell.}\n"


def test_own_names_come_first_then_those_of_the_ontology(tmp_path: Path) -> None:
    graph = extension_graph(yaml_file(tmp_path, KIOSK))
    kiosk = URIRef(f"{HOME}Kiosk")
    assert (kiosk, URIRef(AFN + "scale"), URIRef(AFN + "Large")) in graph
    assert (URIRef(f"{HOME}KioskEntity"), RDFS.subClassOf, URIRef(AFN + "FurnitureEntity")) in graph
    assert (URIRef(HOME[:-1]), RDF.type, OWL.Ontology) in graph


def test_extensions_build_on_each_other_in_any_form(tmp_path: Path) -> None:
    first = yaml_file(tmp_path, KIOSK, "first.yaml")
    row = "Booth,Kiosk,0.4,0.8,0.3,0.5,1.9,2.1"
    header = "name,broader,length_min_m,length_max_m,width_min_m,width_max_m,height_min_m,"
    second = table(tmp_path, "second/categories.csv", f"{header}height_max_m", row).parent
    third = yaml_file(tmp_path, "afbits: [Booth > HangAbility = 0.2]\n", "third.yaml")
    base = AfNet(extensions=[first, second, third])
    assert base.categories["Booth"].broader == "Kiosk"
    assert base.categories["Booth"].iri == "https://example.org/second#Booth"
    assert base.categories["Booth"].afbits["HangAbility"] == 0.2


def test_the_same_file_gives_the_same_statements(tmp_path: Path) -> None:
    path = yaml_file(tmp_path, EVERYTHING)
    texts = {_plain(extension_graph(path)) for _ in range(2)}
    assert len(texts) == 1


def _plain(graph: Graph) -> str:
    return "\n".join(sorted(" ".join(map(str, t)) for t in graph if isinstance(t[0], URIRef)))


def test_homes_are_found_beside_the_file(tmp_path: Path) -> None:
    counts = table(tmp_path, "rooms.csv", "building,room,category,objects")
    assert extension_homes(yaml_file(tmp_path, "homes: [rooms.csv]\n")) == [counts]
    assert extension_homes(yaml_file(tmp_path, KIOSK)) == []


def test_words_are_words_and_numbers_numbers(tmp_path: Path) -> None:
    body = "label: on\nsource: 2026-11-22\nparameters: {A: 1e-3, B: .5, C: -2}\n"
    sheet = yaml_sheet(yaml_file(tmp_path, body), Problems(tmp_path))
    assert sheet.label == "on"
    assert [e.row["value"] for e in sheet.entries] == ["0.001", "0.5", "-2"]
    assert sheet.entries[0].row["source"] == "2026-11-22"


extents = st.tuples(
    st.floats(0.01, 3, allow_subnormal=False), st.floats(0.01, 3, allow_subnormal=False)
).map(sorted)


@settings(
    max_examples=15, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(extents, extents, extents, st.floats(0.01, 1))
def test_any_sizes_come_back_as_they_were_written(
    tmp_path: Path, length: list[float], width: list[float], height: list[float], strength: float
) -> None:
    body = (
        f"categories:\n  Kiosk:\n    broader: Furniture\n    length_m: {length}\n"
        f"    width_m: {width}\n    height_m: {height}\n"
        f"    afbits: ['HangAbility = {strength:.6f}']\n"
    )
    graph = extension_graph(yaml_file(tmp_path, body))
    kiosk = URIRef(f"{HOME}Kiosk")
    for what, (low, high) in (("length", length), ("width", width), ("height", height)):
        assert float(str(graph.value(kiosk, URIRef(f"{AFN}{what}Min")))) == low
        assert float(str(graph.value(kiosk, URIRef(f"{AFN}{what}Max")))) == high
    stated = graph.value(URIRef(f"{HOME}Kiosk.HangAbility"), URIRef(AFN + "strength"))
    assert float(str(stated)) == pytest.approx(strength, abs=1e-6)
