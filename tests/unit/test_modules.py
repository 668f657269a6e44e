from __future__ import annotations

import shutil
from collections import Counter
from functools import cache
from pathlib import Path

import pytest
from rdflib import BNode, Graph, Literal, Namespace, URIRef
from rdflib.namespace import OWL, RDF, RDFS, SKOS

from afkb.knowledge import AFN
from afkb.ontology.build import build_ontology
from afkb.ontology.modules import CATALOG, MODULES, Module, split, write_modules
from afkb.ontology.names import ONTOLOGY_IRI, VERSION
from afkb.quality.reading import plain, read_graph
from small_ontology import small_tables

A = Namespace(AFN)
WHOLE = URIRef(ONTOLOGY_IRI)


@cache
def built() -> Graph:
    import tempfile

    with tempfile.TemporaryDirectory() as folder:
        return build_ontology(small_tables(Path(folder)))


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("ontology") / "modules"
    write_modules(built(), path)
    return path


def without_headers(graph: Graph) -> Graph:
    body = Graph()
    for statement in graph:
        if not str(statement[0]).startswith(ONTOLOGY_IRI) or "#" in str(statement[0]):
            body.add(statement)
    return body


def named(graph: Graph) -> Counter[tuple[str, ...]]:
    """The statements, blank nodes all alike."""
    return Counter(
        tuple("_" if isinstance(term, BNode) else term.n3() for term in statement)
        for statement in graph
    )


def test_every_statement_is_in_exactly_one_module() -> None:
    parts = {name: without_headers(part) for name, part in split(built()).items()}
    whole = without_headers(built())
    union = Graph()
    for part in parts.values():
        assert len(part) > 0
        for statement in part:
            union.add(statement)
    assert sum(map(len, parts.values())) == len(whole)
    assert set(union) == set(whole)


def test_the_files_say_the_same_as_the_whole(folder: Path) -> None:
    union = Graph()
    for module in MODULES:
        union += read_graph(folder / f"{module.name}.owl")
    assert named(without_headers(union)) == named(without_headers(plain(built())))


@pytest.mark.parametrize("module", MODULES, ids=lambda m: m.name)
def test_a_module_loads_alone_with_what_it_imports_from_the_folder(
    module: Module, folder: Path, tmp_path: Path
) -> None:
    import owlready2

    shutil.copytree(folder, tmp_path / "copy")
    owlready2.onto_path[:] = [str(tmp_path / "copy")]
    world = owlready2.World()
    onto = world.get_ontology(module.iri).load(only_local=True)
    assert [o.base_iri.rstrip("#/") for o in onto.imported_ontologies] == [
        f"{ONTOLOGY_IRI}/{name}" for name in module.imports
    ]
    assert world[AFN + "Affordance"] is not None


def upwards(name: str) -> set[str]:
    module = next(m for m in MODULES if m.name == name)
    return {name}.union(*(upwards(i) for i in module.imports))


def test_a_module_imports_every_module_that_it_needs() -> None:
    parts = split(built())
    home = {
        subject: name
        for name, part in parts.items()
        for subject in part.subjects(RDF.type)
        if str(subject).startswith(AFN)
    }
    for name, part in parts.items():
        seen = upwards(name)
        for subject, predicate, value in part:
            if predicate == A.entityClass:
                continue
            for term in (predicate, value):
                assert home.get(term, name) in seen, (name, subject, predicate, value)


def test_each_header_has_its_version_licence_dates_and_origin(folder: Path) -> None:
    for path, iri in [(folder / f"{m.name}.owl", m.iri) for m in MODULES]:
        header = read_graph(path).predicate_objects(URIRef(iri))
        said = {str(p).rsplit("#", 1)[-1].rsplit("/", 1)[-1]: str(o) for p, o in header}
        assert said["versionIRI"] == f"{iri}/{VERSION}"
        assert {"license", "creator", "created", "modified", "title"} <= set(said)
        assert "reconstruction" in said["comment"]


def test_the_whole_imports_nothing_and_says_which_module_defines_a_term() -> None:
    assert not list(built().objects(WHOLE, OWL.imports))
    assert built().value(WHOLE, OWL.priorVersion) == URIRef(f"{ONTOLOGY_IRI}/0.1.0")
    parts = split(built())
    for subject, module in built().subject_objects(RDFS.isDefinedBy):
        name = str(module).removeprefix(f"{ONTOLOGY_IRI}/")
        assert (subject, RDFS.isDefinedBy, module) in parts[name]
    defined = set(built().subjects(RDFS.isDefinedBy))
    assert {A.Mug, A.affords, A.MugEntity, A.SupportAbility, A.Kitchen, A.Dual} <= defined
    assert built().value(A.ChairSuggestsTable, RDFS.isDefinedBy) == URIRef(
        f"{ONTOLOGY_IRI}/relations"
    )


def test_the_catalog_names_every_file_of_the_folder(folder: Path) -> None:
    import xml.etree.ElementTree as Tree

    entries = {e.get("name"): e.get("uri") for e in Tree.parse(folder / CATALOG).getroot()}
    assert entries[ONTOLOGY_IRI] == "../afnet.owl"
    for module in MODULES:
        assert (folder / str(entries[module.iri])).is_file()
        assert entries[f"{module.iri}/{VERSION}"] == entries[module.iri]


def test_the_same_tables_give_the_same_modules(folder: Path, tmp_path: Path) -> None:
    write_modules(build_ontology(small_tables(tmp_path / "again")), tmp_path / "modules")
    for path in folder.iterdir():
        assert path.read_bytes() == (tmp_path / "modules" / path.name).read_bytes()


def test_every_term_has_a_label_a_definition_and_an_example() -> None:
    graph = built()
    for subject in graph.subjects(RDFS.isDefinedBy):
        for predicate in (RDFS.label, SKOS.definition):
            assert graph.value(subject, predicate), f"{subject} has no {predicate}"
    kinds = (OWL.Class, OWL.ObjectProperty, OWL.DatatypeProperty, OWL.AnnotationProperty)
    terms = {s for kind in kinds for s in graph.subjects(RDF.type, kind) if s.startswith(AFN)}
    features = {
        s
        for kind in ("StructuralAffordance", "MaterialAffordance", "GraspAffordance", "Dual")
        for s in graph.subjects(RDF.type, A[kind])
    }
    for subject in terms | features:
        assert graph.value(subject, SKOS.example), f"{subject} has no example"


def test_domains_and_ranges_hold_for_every_statement() -> None:
    graph = built()
    for prop, side in ((p, s) for s in (RDFS.domain, RDFS.range) for p in graph.subjects(s)):
        wanted = graph.value(prop, side)
        if not str(wanted).startswith(AFN):
            continue
        below = set(graph.transitive_subjects(RDFS.subClassOf, wanted))
        for subject, value in graph.subject_objects(prop):
            one = subject if side == RDFS.domain else value
            assert not isinstance(one, Literal)
            assert below & set(graph.objects(one, RDF.type)), f"{prop}: {one} is no {wanted}"


def test_a_rule_has_an_afbit_that_it_makes_as_example() -> None:
    graph = built()
    made = {str(label) for a in graph.subjects(A.byRule) for label in graph.objects(a, RDFS.label)}
    rules = list(graph.subjects(RDF.type, A.AfbitRule))
    examples = [str(e) for rule in rules for e in graph.objects(rule, SKOS.example)]
    assert examples and set(examples) <= made
