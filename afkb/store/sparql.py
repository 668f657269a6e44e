"""SPARQL 1.1 over maps and the ontology, on Oxigraph; reads only, and never the network."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path

from pyoxigraph import (
    NamedNode,
    Quad,
    QueryBoolean,
    QuerySolutions,
    QueryTriples,
    RdfFormat,
    Store,
)

from afkb.errors import QueryError
from afkb.knowledge.cache import cached_file, ontology_key
from afkb.knowledge.closure import classify, close_ontology, closed_ontology
from afkb.knowledge.definitions import Definitions
from afkb.ontology.rdf_files import RDF_FORMATS, unreadable
from afkb.store.results import QueryResult
from afkb.store.sparql_text import refuse_writing, syntax_error
from afkb.store.stored import StoredMap
from afkb.store.vocabulary import PREFIXES, escaped

ONTOLOGY_GRAPH = "urn:afkb:ontology"


def query(maps: Sequence[StoredMap], sparql: str, ontology: Iterable[Path] = ()) -> QueryResult:
    """The answer to a SELECT, ASK, CONSTRUCT or DESCRIBE over one or several maps.

    The default graph is everything together; `GRAPH ?map { … }` tells maps apart: a map's graph
    is `urn:afkb:map:<name of its folder>`, the ontology's `urn:afkb:ontology`; what follows from
    both is in `urn:afkb:inferred` and `urn:afkb:believed`. Prefixes (`afn:`, `geo:`, `prov:`,
    `skos:`, … and `scene:` for the first map) need no declaration. `ontology`:
    the ontology and its extensions, in order. `QueryError`, with line and column, for what can't
    be parsed, and for updates and SERVICE.
    """
    refuse_writing(sparql)
    prefixes = dict(PREFIXES) | ({"scene": maps[0].base} if maps else {})
    # Parsed against nothing first: a slip in the query is told before anything is loaded.
    _run(Store(), sparql, prefixes)
    store = dataset(maps, ontology)
    answer = _run(store, sparql, prefixes)
    try:
        return QueryResult.read(answer, prefixes)
    except OSError as error:
        raise QueryError(f"the query failed while it ran: {error}") from error


def dataset(maps: Sequence[StoredMap], ontology: Iterable[Path] = ()) -> Store:
    """Maps and ontology in one store, a named graph each, with what follows from them."""
    store = Store()
    load_closed(store, tuple(ontology))
    definitions = Definitions.read(store)
    names: set[str] = set()
    for stored in maps:
        name = graph_name(stored.folder, names)
        graph = NamedNode(name)
        store.bulk_extend(_in_graph(stored, graph))
    classify(store, definitions, names)
    return store


def graph_name(folder: Path, taken: set[str]) -> str:
    """`urn:afkb:map:<folder>`; a second folder of the same name gets a number."""
    stem = name = f"urn:afkb:map:{escaped(folder.resolve().name)}"
    number = 1
    while name in taken:
        number += 1
        name = f"{stem}-{number}"
    taken.add(name)
    return name


def _in_graph(stored: StoredMap, graph: NamedNode) -> Iterable[Quad]:
    for quad in stored.store:
        yield Quad(quad.subject, quad.predicate, quad.object, graph)


def load_closed(store: Store, files: Sequence[Path]) -> None:
    """Add the ontology, its extensions and what they entail, from a cache where that was done."""
    if not files:
        return
    kept = cached_file("closed.nq", ontology_key(files), lambda: _closed(files))
    if kept is None:
        load_ontologies(store, files)
        close_ontology(store)
        return
    # Lenient: it was checked when it was first read, and reads in three quarters of the time.
    store.bulk_load(path=str(kept), format=RdfFormat.N_QUADS, lenient=True)


def _closed(files: Sequence[Path]) -> bytes:
    store = Store()
    load_ontologies(store, files)
    return closed_ontology(store)


def load_ontologies(store: Store, files: Sequence[Path]) -> None:
    """Add the ontology and its extensions; `KnowledgeError` where one can't be read."""
    plain = [path for path in files if path.suffix not in RDF_FORMATS]
    if plain:
        from afkb.extensions import read_stack

        for graph in read_stack(files).values():
            text = graph.serialize(format="nt", encoding="utf-8")
            form = RdfFormat.N_TRIPLES
            store.bulk_load(input=text, format=form, to_graph=NamedNode(ONTOLOGY_GRAPH))
    for path in files:
        if path not in plain:
            load_ontology(store, path)


def load_ontology(store: Store, path: Path) -> None:
    """Add an OWL file to the store; `KnowledgeError` where it can't be read."""
    form = RDF_FORMATS[path.suffix]
    try:
        store.bulk_load(path=str(path), format=form, to_graph=NamedNode(ONTOLOGY_GRAPH))
    except (SyntaxError, ValueError, OSError) as error:
        raise unreadable(path, error) from error


def _run(
    store: Store, sparql: str, prefixes: dict[str, str]
) -> QuerySolutions | QueryBoolean | QueryTriples:
    try:
        return store.query(sparql, prefixes=prefixes, use_default_graph_as_union=True)
    except SyntaxError as error:
        raise syntax_error(sparql, error) from error
    except (ValueError, OSError) as error:
        raise QueryError(f"the query can't be answered: {error}") from error
