from __future__ import annotations

import shutil
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from pyoxigraph import DefaultGraph, NamedNode, Quad, RdfFormat, Store

from afkb.knowledge.closure import (
    BELIEVED_GRAPH,
    INFERRED_GRAPH,
    classify,
    close_ontology,
    closed_ontology,
)
from afkb.knowledge.definitions import Definitions
from afkb.ontology.build import build_ontology
from afkb.ontology.header import PREFIXES
from afkb.ontology.names import AFN
from afkb.ontology.rdfxml import to_rdfxml
from small_ontology import small_tables

needs_java = pytest.mark.skipif(shutil.which("java") is None, reason="HermiT needs Java")
MAP = "urn:afkb:map:test"
SCENE = "https://example.org/scene#"
_HEAD = f"@prefix afn: <{AFN}> . @prefix : <{SCENE}> .\n"


@cache
def ontology() -> str:
    import tempfile

    with tempfile.TemporaryDirectory() as folder:
        return to_rdfxml(build_ontology(small_tables(Path(folder))), PREFIXES)


def with_scene(turtle: str) -> Store:
    """The small ontology closed, and the map classified by it."""
    store = Store()
    store.bulk_load(
        input=ontology(), format=RdfFormat.RDF_XML, to_graph=NamedNode("urn:afkb:ontology")
    )
    close_ontology(store)
    store.bulk_load(input=_HEAD + turtle, format=RdfFormat.TURTLE, to_graph=NamedNode(MAP))
    classify(store, Definitions.read(store), [MAP])
    return store


def ask(store: Store, sparql: str) -> list[str]:
    prefixes = {"afn": AFN, "": SCENE, "rdfs": "http://www.w3.org/2000/01/rdf-schema#"}
    prefixes["skos"] = "http://www.w3.org/2004/02/skos/core#"
    rows = store.query(sparql, prefixes=prefixes, use_default_graph_as_union=True)
    return sorted(row[0].value.rsplit("#", 1)[-1] for row in rows)


def types(store: Store, name: str) -> set[str]:
    return set(ask(store, f"SELECT ?c {{ :{name} a ?c }}"))


def test_a_thing_is_of_every_class_above_its_own() -> None:
    store = with_scene(":e1 a afn:KitchenTableEntity .")
    assert {"TableEntity", "FurnitureEntity", "Entity"} <= types(store, "e1")
    assert ask(store, "SELECT ?x { ?x a afn:FurnitureEntity }") == ["e1"]
    assert "Thing" not in types(store, "e1")


def test_subclass_and_broader_go_through_all_levels() -> None:
    store = with_scene("")
    below = ask(store, "SELECT ?c { ?c rdfs:subClassOf afn:FurnitureEntity }")
    assert {"TableEntity", "KitchenTableEntity"} <= set(below)
    broader = ask(store, "SELECT ?b { afn:KitchenTable skos:broaderTransitive ?b }")
    assert broader == ["Furniture", "Table"]
    assert ask(store, "SELECT ?b { afn:KitchenTable skos:broader ?b }") == ["Table"]


def test_an_entity_is_classified_by_what_it_affords_its_scale_and_height() -> None:
    store = with_scene(
        ":e1 a afn:ObservedEntity ; afn:affords afn:SupportAbility ; afn:scale afn:Large ;"
        " afn:z 0.73e0 . :e2 a afn:ObservedEntity ; afn:affords afn:SupportAbility ; afn:z 0.73e0 ."
        ":e3 a afn:ObservedEntity ; afn:affords afn:SupportAbility ; afn:scale afn:Large ;"
        " afn:z 1.5e0 ."
    )
    assert {"LargeTableHeightSupportEntity", "TableHeightSupportEntity"} <= types(store, "e1")
    assert "LargeTableHeightSupportEntity" not in types(store, "e2") | types(store, "e3")
    assert "TallSupportEntity" in types(store, "e3")


def test_the_ends_of_a_range_are_in_it() -> None:
    things = "".join(
        f":e{i} a afn:ObservedEntity ; afn:affords afn:SupportAbility ; afn:z {z}e0 .\n"
        for i, z in enumerate((0.619, 0.62, 0.84, 0.841))
    )
    store = with_scene(things)
    assert ask(store, "SELECT ?x { ?x a afn:TableHeightSupportEntity }") == ["e1", "e2"]


def test_what_affords_a_feature_affords_the_broader_one() -> None:
    store = with_scene(
        ":e1 a afn:ObservedEntity ; afn:affords afn:IntrinsicContainAbility ; afn:scale afn:Small ."
    )
    assert "ContainAbility" in ask(store, "SELECT ?f { :e1 afn:affords ?f }")
    assert {"SmallVesselEntity", "SmallPackageEntity"} <= types(store, "e1")


def test_a_class_gives_its_things_what_all_of_them_afford() -> None:
    store = with_scene(":e1 a afn:MirrorEntity .")
    assert ask(store, "SELECT ?f { :e1 afn:affords ?f }") == ["ReflectAbility"]


def test_a_defined_class_gives_its_things_all_that_the_definition_asks() -> None:
    store = with_scene(":e1 a afn:ChairLikeSeatEntity .")
    assert {"SeatHeightSeatEntity", "SeatEntity", "Entity"} <= types(store, "e1")
    assert "SitAbility" in ask(store, "SELECT ?f { :e1 afn:affords ?f }")


def test_what_is_stated_is_not_said_again_and_what_follows_stands_apart() -> None:
    store = with_scene(
        ":e1 a afn:ObservedEntity, afn:Entity ; afn:affords afn:SupportAbility ; afn:z 0.7e0 ;"
        " afn:inRoom :r1 . :r1 a afn:Room ."
    )
    inferred = list(store.quads_for_pattern(None, None, None, NamedNode(INFERRED_GRAPH)))
    for quad in inferred:
        same = list(store.quads_for_pattern(quad.subject, quad.predicate, quad.object, None))
        assert same == [quad]
    assert ask(store, "SELECT ?c { :r1 a ?c }") == ["Room"]
    stated = store.quads_for_pattern(NamedNode(SCENE + "e1"), None, None, NamedNode(MAP))
    assert len(list(stated)) == 5


def test_a_likely_category_gives_its_class_apart_from_what_is_entailed() -> None:
    store = with_scene(
        ":e1 a afn:ObservedEntity ; afn:categoryBelief :b1, :b2 ."
        ":b1 afn:category afn:KitchenTable ; afn:probability 0.7e0 ."
        ":b2 afn:category afn:Desk ; afn:probability 0.3e0 ."
        ":e2 a afn:ObservedEntity ; afn:categoryBelief :b3 ."
        ":b3 afn:category afn:Desk ; afn:probability 0.5e0 ."
    )
    assert {"KitchenTableEntity", "TableEntity", "FurnitureEntity"} <= types(store, "e1")
    assert "DeskEntity" not in types(store, "e1") | types(store, "e2")
    believed = store.quads_for_pattern(None, None, None, NamedNode(BELIEVED_GRAPH))
    names = {str(quad.object.value).rsplit("#", 1)[-1] for quad in believed}  # type: ignore[union-attr]
    assert names == {"KitchenTableEntity", "TableEntity", "FurnitureEntity"}


def test_a_cycle_of_classes_ends() -> None:
    store = Store()
    a, b = NamedNode("urn:a"), NamedNode("urn:b")
    above = NamedNode("http://www.w3.org/2000/01/rdf-schema#subClassOf")
    for one, other in ((a, b), (b, a)):
        store.add(Quad(one, above, other, DefaultGraph()))
    assert close_ontology(store) == 0


def test_a_closed_ontology_can_be_kept_and_loaded_instead() -> None:
    store = Store()
    store.bulk_load(
        input=ontology(), format=RdfFormat.RDF_XML, to_graph=NamedNode("urn:afkb:ontology")
    )
    before = len(store)
    kept = closed_ontology(store)
    again = Store()
    again.bulk_load(input=kept, format=RdfFormat.N_QUADS)
    assert len(again) == len(store) > before
    assert len(Definitions.read(again).defined) == len(Definitions.read(store).defined) > 30


def test_queries_over_a_map_see_what_follows(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from afkb.store import load, query, write_map
    from store_samples import Names, sample_map

    monkeypatch.setenv("AFKB_CACHE", str(tmp_path / "cache"))
    owl = tmp_path / "small.owl"
    owl.write_text(ontology(), encoding="utf-8")
    stored = load(write_map(tmp_path / "home", sample_map(), {}, [], Names()))
    for _ in range(2):
        asked = "SELECT ?x { ?x a afn:TableEntity ; afn:scale afn:Large }"
        assert ("scene:n1",) in query([stored], asked, [owl]).cells()
        asked = "SELECT ?x { GRAPH ?map { ?x a afn:ObservedEntity } ?x a afn:SmallVesselEntity }"
        assert query([stored], asked, [owl]).cells() == [("scene:n2",)]
        asked = "SELECT (COUNT(*) AS ?n) { scene:n1 a afn:ObservedEntity }"
        assert query([stored], asked, [owl]).cells() == [("1",)]
    assert [path.suffix for path in (tmp_path / "cache").iterdir()] == [".nq"]


def random_scene(rng: np.random.Generator, count: int) -> str:
    features = ["SupportAbility", "ContainAbility", "IntrinsicContainAbility", "SitAbility"]
    features += ["LieAbility", "BlockAbility", "TransmitAbility", "DisplayAbility", "PassAbility"]
    classes = ["ObservedEntity", "DualPrediction", "MugEntity", "KitchenTableEntity", "BedEntity"]
    classes += ["StandingMirrorEntity", "ChairLikeSeatEntity", "LargeLowSupportEntity"]
    lines = []
    for i in range(count):
        afforded = rng.choice(features, size=rng.integers(0, 4), replace=False)
        lines.append(f":e{i} a afn:{rng.choice(classes)} ; afn:z {rng.uniform(-0.1, 2.3):.3f}e0 .")
        lines += [f":e{i} afn:affords afn:{feature} ." for feature in afforded]
        if rng.random() < 0.8:
            lines.append(f":e{i} afn:scale afn:{rng.choice(['Small', 'Medium', 'Large'])} .")
    return "\n".join(lines)


@needs_java
def test_types_are_those_that_hermit_finds(tmp_path: Path) -> None:
    import owlready2

    turtle = random_scene(np.random.default_rng(20261122), 30)
    store = with_scene(turtle)
    whole = Store()
    whole.bulk_load(input=ontology(), format=RdfFormat.RDF_XML)
    whole.bulk_load(input=_HEAD + turtle, format=RdfFormat.TURTLE)
    path = tmp_path / "whole.nt"
    path.write_bytes(whole.dump(format=RdfFormat.N_TRIPLES, from_graph=DefaultGraph()) or b"")
    world = owlready2.World()
    world.get_ontology(path.as_uri()).load()
    with world.get_ontology("http://example.org/inferred"):
        owlready2.sync_reasoner_hermit(world, infer_property_values=False, debug=0)
    for i in range(30):
        individual = world[f"{SCENE}e{i}"]
        found = {
            c.name for parent in individual.is_a for c in parent.ancestors() if hasattr(c, "name")
        }
        ours = types(store, f"e{i}") - {"NamedIndividual"}
        assert ours == found - {"Thing", "NamedIndividual"}, f"e{i}"
