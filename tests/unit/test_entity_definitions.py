from __future__ import annotations

from collections import defaultdict
from functools import cache

import pytest
from rdflib import Graph, Namespace
from rdflib.collection import Collection
from rdflib.namespace import OWL

from afkb.csv_rows import Row
from afkb.errors import KnowledgeError
from afkb.knowledge import bundled_ontology
from afkb.ontology.entity_classes import STRONG
from afkb.ontology.entity_definitions import (
    EntityDefinition,
    Typical,
    add_definitions,
    typical_thing,
    unsound,
)
from afkb.ontology.names import AFN, SOMETHING_ELSE
from afkb.ontology.subjects import kinds_of
from afkb.ontology.table_folder import Tables

A = Namespace(AFN)
XML_SCHEMA = Namespace("http://www.w3.org/2001/XMLSchema#")


@cache
def tables() -> Tables:
    return Tables.read(bundled_ontology().parent / "tables")


@cache
def things() -> list[Typical]:
    """A typical thing of every category, with the strong afbits that were admitted."""
    rows = tables().rows
    wholes = {"", *(row["name"] for row in rows["parts"] if row.get("whole") == "yes")}
    broader = {row["name"]: row.get("broader") for row in rows["features"]}
    afforded: dict[str, set[str]] = defaultdict(set)
    for afbit in tables().afbits():
        strong = afbit.refusal() is None and afbit.row().number("strength") >= STRONG
        if strong and afbit.kind != "grasp" and afbit.key[1] in wholes:
            afforded[afbit.key[0]].update(kinds_of(afbit.key[2], broader))
    return [
        typical_thing(row, afforded[row["name"]])
        for row in rows["categories"]
        if row["name"] != SOMETHING_ELSE
    ]


def definitions() -> list[EntityDefinition]:
    return [EntityDefinition.read(row) for row in tables().rows["entity_definitions"]]


def test_a_category_that_fits_a_definition_is_of_its_category() -> None:
    rows = [*tables().rows["categories"], *tables().rows["category_groups"]]
    broader = {row["name"]: row.get("broader") for row in rows}
    assert list(unsound(definitions(), things(), broader)) == []
    assert {d.name for d in definitions()} & set(broader) >= {
        "Food",
        "StandingMirror",
        "VacuumCleaner",
        "Hammer",
        "Shovel",
    }


def test_every_definition_is_met_by_some_category() -> None:
    for definition in definitions():
        assert any(definition.holds(thing) for thing in things()), definition.name


def test_a_definition_tells_what_it_is_meant_to_tell() -> None:
    met = {d.name: {t.category for t in things() if d.holds(t)} for d in definitions()}
    assert {"Table", "Desk"} <= met["LargeTableHeightSupport"]
    assert "Bed" not in met["LargeTableHeightSupport"]
    assert {"Chair", "Stool"} <= met["ChairLikeSeat"] and "Couch" not in met["ChairLikeSeat"]
    assert "Mug" in met["SmallVessel"] and "Bathtub" not in met["SmallVessel"]
    assert {"Pen", "Pencil"} <= met["WritingTool"]


def definition(**cells: str) -> EntityDefinition:
    row = {"name": "Seat", "label": "seat", "status": "proposed", "source": "test"} | cells
    return EntityDefinition.read(Row("entity_definitions.csv", 2, row))


def thing(category: str, *features: str, scale: str = "Medium", z: float | None = 0.45) -> Typical:
    return Typical(category, frozenset(features), scale, z)


def test_both_ways_of_being_unsound_are_told() -> None:
    seat = definition(name="Chair", features="SitAbility", z_max_m="0.6")
    broader = {"Chair": "Furniture", "BarStool": "Chair", "Bed": "Furniture"}
    good = thing("Chair", "SitAbility")
    assert list(unsound([seat], [good], broader)) == []
    (told,) = unsound([seat], [good, thing("Bed", "SitAbility")], broader)
    assert told == "entity_definitions.csv, line 2: Bed fits, and is no Chair"
    (told,) = unsound([seat], [good, thing("BarStool", "SitAbility", z=0.75)], broader)
    assert told == "entity_definitions.csv, line 2: BarStool is one, and does not fit"


def test_an_unknown_height_fits_any_range_and_ends_count() -> None:
    seat = definition(features="SitAbility", scale="Medium", z_min_m="0.35", z_max_m="0.45")
    assert seat.holds(thing("X", "SitAbility", z=None))
    assert seat.holds(thing("X", "SitAbility", z=0.45))
    assert not seat.holds(thing("X", "SitAbility", z=0.46))
    assert not seat.holds(thing("X", "SitAbility", scale="Large"))


def test_the_height_of_what_supports_is_its_top_and_else_its_middle() -> None:
    row = Row(
        "c.csv",
        2,
        {"name": "Box", "scale": "Medium", "stands_on": "Floor", "top_min_m": "0.3"}
        | {"top_max_m": "0.5", "height_min_m": "0.3", "height_max_m": "0.5"},
    )
    assert typical_thing(row, ["SupportAbility"]).z_m == pytest.approx(0.4)
    assert typical_thing(row, ["ContainAbility"]).z_m == pytest.approx(0.2)


@pytest.mark.parametrize(
    ("cells", "message"),
    [
        ({"features": ""}, "at least one affordance"),
        ({"features": "SitAbility", "z_min_m": "0.5", "z_max_m": "0.4"}, "expected min < max"),
        ({"features": "SitAbility", "z_min_m": "low"}, "no number"),
    ],
)
def test_a_bad_row_is_told_with_its_place(cells: dict[str, str], message: str) -> None:
    with pytest.raises(KnowledgeError, match=f"entity_definitions.csv, line 2.*{message}"):
        definition(**cells)


def test_a_definition_is_an_intersection_of_restrictions() -> None:
    graph = Graph()
    row = {"definition": "A seat.", "example": "a stool", "scale": "Medium", "z_max_m": "0.6"}
    add_definitions(graph, [definition(features="SitAbility|SupportAbility", **row)])
    whole = graph.value(A.SeatEntity, OWL.equivalentClass)
    members = Collection(graph, graph.value(whole, OWL.intersectionOf))
    assert members[0] == A.Entity and len(members) == 5
    values = {graph.value(m, OWL.hasValue) for m in members}
    assert {A.SitAbility, A.SupportAbility, A.Medium} <= values
    (limit,) = graph.objects(None, XML_SCHEMA.maxInclusive)
    assert limit.n3() == f'"0.6"^^<{XML_SCHEMA.double}>'
