from __future__ import annotations

import csv
import re
from functools import cache
from pathlib import Path

import pytest
from rdflib import Graph, Namespace, URIRef
from rdflib.namespace import DCTERMS, OWL, RDF, RDFS, SKOS

from afkb.csv_rows import Row
from afkb.errors import KnowledgeError
from afkb.knowledge import bundled_ontology
from afkb.ontology.build import build_ontology
from afkb.ontology.links import PUBLIC_TABLE, gather_links, link_files
from afkb.ontology.names import AFN, VERSION
from afkb.ontology.tables import read_table
from afkb.quality.reasoner import Triple, is_consistent, java, logical
from small_ontology import small_tables

needs_java = pytest.mark.skipif(java() is None, reason="HermiT needs Java")
FOLDER = bundled_ontology().parent / "alignments"
FILES = sorted(FOLDER.glob("*.ttl"))
UPPER = Path(__file__).parent / "upper"
A = Namespace(AFN)
SOMA = Namespace("http://www.ease-crc.org/ont/SOMA.owl#")
E = Namespace("https://example.org/scene#")


@cache
def parsed(path: Path) -> Graph:
    return Graph().parse(path, format="turtle")


@cache
def small() -> Graph:
    import tempfile

    with tempfile.TemporaryDirectory() as folder:
        return build_ontology(small_tables(Path(folder)))


@cache
def aligned() -> Graph:
    """The small ontology with every alignment and what matters of the targets' axioms."""
    whole = Graph()
    for graph in (small(), *map(parsed, FILES), *map(parsed, sorted(UPPER.glob("*.ttl")))):
        for statement in graph:
            whole.add(statement)
    return whole


def with_instances(graph: Graph) -> list[Triple]:
    """The statements, with a thing of every class: consistent only where none is empty."""
    classes = {c for c in graph.subjects(RDF.type, OWL.Class) if isinstance(c, URIRef)}
    named = sorted(classes - {OWL.Nothing})
    witnesses = [(E[f"one{n}"], RDF.type, c) for n, c in enumerate(named)]
    return [*logical(graph), *witnesses]


def test_every_target_has_its_file() -> None:
    names = {path.stem for path in FILES}
    assert names == {"dul-soma", "sosa", "bot", "geosparql", "prov", "qudt", "wordnet", "wikidata"}


@pytest.mark.parametrize("path", FILES, ids=lambda p: p.stem)
def test_a_file_has_a_header_and_imports_nothing(path: Path) -> None:
    graph = parsed(path)
    (header,) = graph.subjects(RDF.type, OWL.Ontology)
    assert graph.value(header, OWL.versionIRI) == URIRef(f"{header}/{VERSION}")
    for prop in (DCTERMS.license, DCTERMS.title, DCTERMS.description, DCTERMS.creator):
        assert graph.value(header, prop)
    note = str(graph.value(header, RDFS.comment))
    assert "Target" in note and "hecked" in note and ("licen" in note or "CC" in note)
    assert not list(graph.triples((None, OWL.imports, None)))


@pytest.mark.parametrize("path", FILES, ids=lambda p: p.stem)
def test_a_file_speaks_of_terms_that_the_ontology_has(path: Path) -> None:
    tables = bundled_ontology().parent / "tables"
    names = {
        row["name"]
        for table in ("vocabulary", "features", "categories")
        for row in read_table(tables, table)
    }
    named = {t for statement in parsed(path) for t in statement if str(t).startswith(AFN)}
    assert named and named <= {A[name] for name in names}


def test_features_are_dispositions_and_no_affordances_of_soma() -> None:
    graph = parsed(FOLDER / "dul-soma.ttl")
    assert (A.Affordance, RDFS.subClassOf, SOMA.Disposition) in graph
    terms = {term for statement in graph for term in statement}
    assert SOMA.Affordance not in terms and SOMA.Pourable not in terms
    assert (A.affords, RDFS.subPropertyOf, SOMA.hasDisposition) not in graph


@needs_java
def test_no_class_is_empty_under_the_alignments() -> None:
    assert is_consistent(with_instances(aligned()))


@needs_java
def test_features_as_affordances_of_soma_would_be_caught() -> None:
    wrong = (A.Affordance, RDFS.subClassOf, SOMA.Affordance)
    assert not is_consistent([*logical(aligned()), wrong])


@needs_java
def test_things_that_share_a_feature_stay_two_things() -> None:
    scene = [
        (E.e1, A.affords, A.SupportAbility),
        (E.e2, A.affords, A.SupportAbility),
        (E.e1, RDF.type, A.ObservedEntity),
        (E.e2, RDF.type, A.ObservedEntity),
        (E.e1, OWL.differentFrom, E.e2),
    ]
    assert is_consistent([*logical(aligned()), *scene])
    wrong = (A.affords, RDFS.subPropertyOf, SOMA.hasDisposition)
    # HermiT refuses a cardinality on what a property chain implies; the fault is there without.
    statements = [t for t in logical(aligned()) if t[1] != OWL.propertyChainAxiom]
    assert not is_consistent([*statements, *scene, wrong])


@needs_java
def test_a_robot_place_taken_for_an_element_of_its_room_would_be_caught() -> None:
    bot = Namespace("https://w3id.org/bot#")
    wrong = [
        (A.RobotPlace, RDFS.subClassOf, bot.Element),
        (A.RobotPlace, RDFS.subClassOf, bot.Zone),
    ]
    assert not is_consistent([*with_instances(aligned()), *wrong])


def test_links_are_those_of_the_table_and_each_names_its_row() -> None:
    tables = bundled_ontology().parent / "tables"
    rows = read_table(tables, "links")
    for name, text in link_files(rows, read_table(tables, "units")).items():
        assert (FOLDER / name).read_text(encoding="utf-8") == text, f"{name}: run the build"
    assert len({row["category"] for row in rows}) > 150
    for row in rows:
        assert re.fullmatch(r"i\d+", row["wordnet_ili"])
        assert re.fullmatch(r"\d{8}-n", row["oewn"])
        assert re.fullmatch(r"(Q\d+)?", row.get("wikidata"))
        assert PUBLIC_TABLE in row["source"] and row["status"] == "taken from data"
    wordnet = parsed(FOLDER / "wordnet.ttl")
    mug = set(map(str, wordnet.objects(A.Mug, SKOS.closeMatch)))
    assert any(iri.startswith("http://globalwordnet.org/ili/i") for iri in mug)


def public(folder: Path, *lines: str) -> Path:
    head = "object,bddl_synset,oewn_synset,ili,wikidata,hypernym_check"
    (folder / PUBLIC_TABLE).write_text("\n".join([head, *lines, ""]), encoding="utf-8")
    return folder


def name(category: str, what: str, source: str = "oewn", line: int = 2) -> Row:
    cells = {"category": category, "source": source, "name": what}
    return Row("source_names/x.csv", line, cells)


def test_only_synsets_that_passed_their_check_are_linked(tmp_path: Path) -> None:
    folder = public(
        tmp_path, "mug,mug.n.04,03797390-n,i56034,Q386215,1", "pan,pan.n.01,03880531-n,i56500,,0"
    )
    rows = list(csv.DictReader(gather_links(folder, [name("Mug", "mug")]).splitlines()))
    assert [(r["category"], r["wordnet_ili"], r["wikidata"]) for r in rows] == [
        ("Mug", "i56034", "Q386215")
    ]
    assert "line 2" in rows[0]["source"]
    assert gather_links(folder, [name("Mug", "mug", "bddl")]).count("\n") == 1
    for bad in (name("Pan", "pan"), name("Mug", "beaker")):
        with pytest.raises(KnowledgeError, match=r"source_names/x.csv, line 2.*no checked synset"):
            gather_links(folder, [bad])


def test_every_number_of_the_ontology_has_a_unit_or_is_a_count() -> None:
    tables = bundled_ontology().parent / "tables"
    measured = {row["property"] for row in read_table(tables, "units")}
    doubles = {
        row["name"]
        for row in read_table(tables, "vocabulary")
        if row["kind"] == "data" and row.get("range") == "double"
    }
    plain = {"z1", "n1", "n2", "z2", "value", "successes", "trials", "meanNumber"}
    plain |= {"paperStrength", "dataSuccesses", "dataTrials"}
    assert doubles - measured - plain == set()
