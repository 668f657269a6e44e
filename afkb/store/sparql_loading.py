"""The ontology and its extensions, with what they entail, in a store to ask."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from pyoxigraph import NamedNode, RdfFormat, Store

from afkb.knowledge.cache import cached_file, ontology_key
from afkb.knowledge.closure import close_ontology, closed_ontology
from afkb.ontology.rdf_files import RDF_FORMATS, unreadable

ONTOLOGY_GRAPH = "urn:afkb:ontology"


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
