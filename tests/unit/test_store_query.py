from __future__ import annotations

import csv
import io
import json
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pyoxigraph import Store

from afkb.errors import KnowledgeError, QueryError
from afkb.store import Dataset, StoredMap, load, query, write_map
from afkb.store.named import check_known, named_queries, named_query, read_values
from afkb.store.sparql_text import refuse_writing
from afkb.store.vocabulary import PREFIXES
from store_samples import Names, sample_map


@pytest.fixture(scope="module")
def stored(tmp_path_factory: pytest.TempPathFactory) -> StoredMap:
    folder = tmp_path_factory.mktemp("maps") / "home"
    return load(write_map(folder, sample_map(), {}, [], Names()))


def ask(stored: StoredMap, sparql: str) -> list[tuple[str, ...]]:
    return query([stored], sparql).cells()


def test_containers_come_with_their_support(stored: StoredMap) -> None:
    rows = ask(stored, "SELECT ?c ?s { ?c afn:affords afn:ContainAbility ; afn:supportedBy ?s }")
    assert rows == [("scene:n2", "scene:n1")]


def test_ask_construct_and_describe(stored: StoredMap) -> None:
    assert query([stored], "ASK { ?r a afn:Room }").truth is True
    built = query([stored], "CONSTRUCT { ?n a skos:Concept } WHERE { ?n a afn:RobotPlace }")
    assert built.triples is not None and len(built.triples) == 2
    assert "scene:n1" in query([stored], "DESCRIBE scene:n1").text("ttl")


def test_json_is_sparql_results_json(stored: StoredMap) -> None:
    import rdflib.plugins.sparql.results.jsonresults as standard

    text = query([stored], "SELECT ?n ?x ?nothing { ?n a afn:Room ; afn:x ?x }").text("json")
    parsed = standard.JSONResult(json.loads(text))
    assert [str(v) for v in parsed.vars] == ["n", "x", "nothing"]
    assert sorted(float(b[parsed.vars[1]]) for b in parsed.bindings) == [1.0, 4.0]
    assert json.loads(query([stored], "ASK { ?x a afn:Yeti }").text("json"))["boolean"] is False


def test_csv_has_a_header_and_plain_values(stored: StoredMap) -> None:
    text = query([stored], "SELECT ?label { ?x rdfs:label ?label } ORDER BY ?label").text("csv")
    rows = list(csv.reader(io.StringIO(text)))
    assert rows[0] == ["label"]
    assert ["containers"] in rows


def test_several_maps_are_asked_together_and_told_apart(tmp_path: Path) -> None:
    import dataclasses

    whole = sample_map()
    other = dataclasses.replace(whole, entities=whole.entities[:1], closures=(), edges=())
    maps = [
        load(write_map(tmp_path / "a" / "m", whole, {}, [], Names())),
        load(write_map(tmp_path / "b" / "m", other, {}, [], Names())),
    ]
    counted = query(maps, "SELECT (COUNT(?n) AS ?c) { ?n a afn:ObservedEntity }").cells()
    assert counted == [("4",)]
    by_map = "SELECT ?g (COUNT(?n) AS ?c) { GRAPH ?g { ?n a afn:ObservedEntity } } GROUP BY ?g"
    assert sorted(query(maps, by_map).cells()) == [
        ("urn:afkb:map:m", "3"),
        ("urn:afkb:map:m-2", "1"),
    ]


def test_the_ontology_is_asked_along(stored: StoredMap, tmp_path: Path) -> None:
    extra = tmp_path / "extra.ttl"
    extra.write_text(
        "@prefix afn: <https://w3id.org/afkb/afnet#> .\n"
        "@prefix skos: <http://www.w3.org/2004/02/skos/core#> .\n"
        "afn:Mug skos:broader afn:Container ."
    )
    sparql = "SELECT ?n { ?n afn:categoryBelief/afn:category/skos:broader afn:Container }"
    assert query([stored], sparql, [extra]).cells() == [("scene:n2",)]
    extra.write_text("not turtle")
    with pytest.raises(KnowledgeError, match="not readable"):
        query([stored], sparql, [extra])


@pytest.mark.parametrize(
    ("sparql", "where"),
    [
        ("SELECT ?s WHER { ?s ?p ?o }", "line 1, column 11, near 'WHER"),
        ("SELECT *\nWHERE {\n  ?s ?p ?o .\n  FLTER(?o > 3)\n}", "line 4, column 3, near 'FLTER"),
        ("SELECT ?s WHERE { ?s ?p ?o", "line 1, column 27, at the end"),
        ("SELECT * {\n ?s foo:bar 1 }", "line 2, column 5: the prefix 'foo:'"),
        ("", "line 1, column 1"),
    ],
)
def test_a_syntax_error_has_its_position(stored: StoredMap, sparql: str, where: str) -> None:
    with pytest.raises(QueryError) as told:
        query([stored], sparql)
    assert where in str(told.value)
    assert "\n" not in str(told.value)


@pytest.mark.parametrize(
    "sparql",
    [
        "INSERT DATA { <urn:a> <urn:b> 1 }",
        "# tidy up\nPREFIX x: <urn:insert#>\nDELETE WHERE { ?s ?p ?o }",
        "LOAD <http://example.org/x>",
        "WITH <urn:g> DELETE { ?s ?p ?o } WHERE { ?s ?p ?o }",
        "clear all",
    ],
)
def test_updates_are_refused(stored: StoredMap, sparql: str) -> None:
    with pytest.raises(QueryError, match="read-only"):
        query([stored], sparql)


def test_service_is_refused_but_the_word_may_be_used(stored: StoredMap) -> None:
    with pytest.raises(QueryError, match="line 2, column 3: SERVICE"):
        query([stored], "SELECT * {\n  SERVICE <http://x> { ?s ?p ?o } }")
    sparql = (
        "PREFIX service: <urn:load#> # SERVICE\n"
        "SELECT ?service { ?service service:delete 'INSERT DATA { SERVICE' }"
    )
    assert ask(stored, sparql) == []


@given(st.text(max_size=60))
@settings(max_examples=200)
def test_any_text_gives_an_answer_or_a_query_error(text: str) -> None:
    try:
        refuse_writing(text)
    except QueryError as error:
        assert "line" in str(error)


def test_turtle_needs_triples(stored: StoredMap) -> None:
    with pytest.raises(QueryError, match="CONSTRUCT"):
        query([stored], "SELECT * { ?s ?p ?o }").text("ttl")


def test_parameters_are_filled_in() -> None:
    found = named_query("things-by-category")
    assert [(p.name, p.kind, p.default) for p in found.parameters] == [
        ("category", "afn:", "Table")
    ]
    assert "VALUES ?category { afn:Mug }" in found.filled({"category": "Mug"})
    assert "{ afn:Mug }" in found.filled({"category": "afn:Mug"})
    with pytest.raises(QueryError, match="has no parameter 'kind'; it takes: category=Table"):
        found.filled({"kind": "Mug"})
    with pytest.raises(QueryError, match="a number is wanted"):
        named_query("doubtful-things").filled({"below": "much"})
    with pytest.raises(QueryError, match="NAME=VALUE"):
        read_values(["Mug"])


@given(st.text(min_size=1, max_size=20))
@settings(max_examples=100)
def test_no_value_of_a_parameter_can_change_the_query(value: str) -> None:
    found = named_query("things-by-category")
    try:
        filled = found.filled({"category": value})
    except QueryError:
        return
    assert list(Store().query(filled, prefixes=PREFIXES)) == []
    assert len(filled.splitlines()) == len(found.sparql.splitlines())


def test_each_query_of_the_library_is_sparql_as_it_stands(stored: StoredMap) -> None:
    names = [known.name for known in named_queries()]
    assert len(names) >= 25
    everything = Dataset.load([stored])
    for known in named_queries():
        assert known.about.endswith((".", ")")) or known.about
        everything.ask(known.sparql)


def test_a_value_that_nothing_is_called_is_told_with_names_near_it(stored: StoredMap) -> None:
    everything = Dataset.load([stored])
    support = named_query("on-support")
    check_known(everything.store, support, {"support": "n1"}, stored.base)
    with pytest.raises(QueryError, match="support=n11: nothing is called that; near it: n1"):
        check_known(everything.store, support, {"support": "n11"}, stored.base)
    assert everything.ask(support.filled({"support": "n1"})).cells()[0][:2] == (
        "scene:n2",
        "afn:Mug",
    )


def test_an_unknown_name_lists_the_library() -> None:
    with pytest.raises(QueryError, match="@containers-on-supports"):
        named_query("@containers-on-support")
    with pytest.raises(QueryError, match="no named query"):
        named_query("@../vocabulary")


def test_a_bound_says_how_well_its_line_is_known(stored: StoredMap) -> None:
    asked = "SELECT ?m ?rad { ?b a afn:Bound ; afn:offsetSigma ?m ; afn:yawSigma ?rad }"
    assert ask(stored, asked) == [("0.01", "0.005")]


def test_from_and_from_named_are_all_that_is_asked(tmp_path: Path) -> None:
    import dataclasses

    whole = sample_map()
    other = dataclasses.replace(whole, entities=whole.entities[:1], closures=(), edges=())
    maps = [
        load(write_map(tmp_path / name, content, {}, [], Names()))
        for name, content in (("a", whole), ("b", other))
    ]
    both = Dataset.load(maps)

    def count(clause: str, **graphs: list[str]) -> str:
        sparql = f"SELECT (COUNT(?n) AS ?c) {clause} {{ ?n a afn:ObservedEntity }}"
        return both.ask(sparql, **graphs).cells()[0][0]

    assert count("") == "4"
    assert count("FROM <urn:afkb:map:b>") == "1"
    assert count("FROM <urn:afkb:map:a> FROM <urn:afkb:map:b>") == "4"
    assert count("FROM NAMED <urn:afkb:map:b>") == "0"
    assert count("FROM <urn:afkb:map:a>", default_graphs=["urn:afkb:map:b"]) == "1"
    assert count("FROM <urn:afkb:believed>") == "0"
    by_graph = "SELECT DISTINCT ?g FROM NAMED <urn:afkb:map:b> { GRAPH ?g { ?s ?p ?o } }"
    assert both.ask(by_graph).cells() == [("urn:afkb:map:b",)]
    with pytest.raises(QueryError, match="no graph <urn:x> here; there are: urn:afkb:believed"):
        both.ask("SELECT * # FROM\nFROM # <urn:y>\n<urn:x> { ?s ?p ?o }")


GLUE = st.sampled_from(
    [
        "SERVICE", "service", "SILENT", "<http://127.0.0.1:1/>", ":x", "a:x", "service:x", "{", "}",
        "{ ?s ?p ?o }", "?x", "?s ?p ?o", ".", "<", "<2", ">", "#", "#>", "\n", " ", ")", "FILTER(",
        "?x", "\\#", "\\'", "'", '"', "FILTER(?x<2)", "a:b.", "true.", "BIND(1 AS ?x)", "UNION",
    ]
)  # fmt: skip


@given(st.lists(GLUE, max_size=8))
@settings(max_examples=80, deadline=None)
def test_no_call_of_another_server_hides_from_the_guard(pieces: list[str]) -> None:
    """Oxigraph is the judge: it refuses to call port 1, and says so when it would."""
    prefixes = "".join(f"PREFIX {name}: <http://127.0.0.1:1/> " for name in ("", "a", "service"))
    sparql = f"{prefixes} SELECT * {{ {{}} UNION {{ {''.join(pieces)} }} }}"
    try:
        refuse_writing(sparql)
    except QueryError:
        return
    try:
        Store().query(sparql)
    except (SyntaxError, ValueError, RuntimeError):
        return
    except OSError as called:
        raise AssertionError(sparql) from called


@pytest.mark.parametrize(
    "hidden",
    [
        "SERVICE:x { ?s ?p ?o }",
        "SERVICEa:x { ?s ?p ?o }",
        "SERVICESILENT <http://127.0.0.1:1/> { ?s ?p ?o }",
        "?s a:x\\# 1 . SERVICE <http://127.0.0.1:1/> { ?s ?p ?o }",
        "?s a:x\\' 1 . SERVICE <http://127.0.0.1:1/> { ?s a:x\\' 2 }",
        "BIND(1 AS ?x) FILTER(?x<2)SERVICE#>\n<http://127.0.0.1:1/> { ?s ?p ?o }",
    ],
)
def test_a_hidden_service_is_refused(hidden: str) -> None:
    prefixes = "PREFIX : <http://127.0.0.1:1/> PREFIX a: <urn:a#> "
    with pytest.raises(QueryError, match="SERVICE"):
        refuse_writing(f"{prefixes} SELECT * {{ {hidden} }}")


def test_a_query_that_takes_too_long_is_given_up(stored: StoredMap) -> None:
    slow = "SELECT (COUNT(*) AS ?n) { ?a ?b ?c . ?d ?e ?f FILTER(STR(?c) < STR(?f)) }"
    with pytest.raises(QueryError, match=r"no answer within 0\.001 s"):
        query([stored], slow, timeout_s=0.001)
    assert query([stored], "ASK { ?r a afn:Room }", timeout_s=60).truth


@pytest.mark.parametrize("form", ["csv", "tsv", "json", "xml"])
def test_each_form_reads_back_the_same(stored: StoredMap, form: str) -> None:
    from pyoxigraph import QueryResultsFormat, parse_query_results

    asked = "SELECT ?n ?label ?x { ?n rdfs:label ?label OPTIONAL { ?n afn:x ?x } } ORDER BY ?n"
    answer = query([stored], asked)
    formats = {
        "csv": QueryResultsFormat.CSV,
        "tsv": QueryResultsFormat.TSV,
        "json": QueryResultsFormat.JSON,
        "xml": QueryResultsFormat.XML,
    }
    if form == "csv":
        assert len(list(csv.reader(io.StringIO(answer.text(form))))) == len(answer.rows) + 1
        return
    parsed = parse_query_results(answer.text(form).encode(), format=formats[form])
    assert [tuple(row) for row in parsed] == list(answer.rows)  # type: ignore[union-attr]


def test_triples_are_written_in_each_form(stored: StoredMap) -> None:
    from pyoxigraph import RdfFormat, parse

    answer = query([stored], "DESCRIBE scene:n1")
    for form, read in (("nt", RdfFormat.N_TRIPLES), ("xml", RdfFormat.RDF_XML)):
        quads = parse(answer.text(form).encode(), format=read)
        assert len(list(quads)) == len(answer.rows)
    assert answer.text("csv").startswith("subject,predicate,object")
    assert query([stored], "ASK {}").text("csv") == "answer\ntrue\n"
