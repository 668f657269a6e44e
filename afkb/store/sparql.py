"""SPARQL 1.1 over maps and the ontology, on Oxigraph; reads only, and never the network."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from pyoxigraph import NamedNode, Quad, QueryBoolean, QuerySolutions, QueryTriples, Store

from afkb.errors import QueryError
from afkb.knowledge.closure import BELIEVED_GRAPH, INFERRED_GRAPH, classify
from afkb.knowledge.definitions import Definitions
from afkb.store.limited import within
from afkb.store.results import QueryResult
from afkb.store.sparql_loading import ONTOLOGY_GRAPH, load_closed
from afkb.store.sparql_text import (
    check_syntax,
    graphs_named,
    names_its_dataset,
    refuse_writing,
    syntax_error,
)
from afkb.store.stored import StoredMap
from afkb.store.vocabulary import PREFIXES, map_graph

_ALWAYS_THERE = {ONTOLOGY_GRAPH, INFERRED_GRAPH, BELIEVED_GRAPH}
Answer = QuerySolutions | QueryBoolean | QueryTriples


def query(
    maps: Sequence[StoredMap],
    sparql: str,
    ontology: Iterable[Path] = (),
    timeout_s: float | None = None,
) -> QueryResult:
    """The answer to a SELECT, ASK, CONSTRUCT or DESCRIBE over one or several maps.

    For one question; `Dataset.load` keeps the maps for several. Prefixes (`afn:`, `geo:`, `prov:`,
    `skos:`, … and `scene:` for the first map) need no declaration. `ontology`: the ontology and its
    extensions, in order. `QueryError`, with line and column, for what can't be parsed, and for
    updates and SERVICE.
    """
    refuse_writing(sparql)
    # First of all: a slip in the query is told before anything is loaded.
    check_syntax(sparql, prefixes_for(maps))
    return Dataset.load(maps, ontology).ask(sparql, timeout_s=timeout_s)


@dataclass(frozen=True, slots=True)
class Dataset:
    """Maps and the ontology, loaded once and asked often.

    The default graph is everything together; `GRAPH ?map { … }` tells maps apart: a map's graph
    is `urn:afkb:map:<name of its folder>`, the ontology's `urn:afkb:ontology`; what follows from
    both is in `urn:afkb:inferred` and `urn:afkb:believed`. A query with `FROM` or `FROM NAMED` is
    about those graphs and no others.

    - `store`: all of it; treat it as read-only.
    - `graphs`: the maps' graphs, each with the map's folder, in the order given.
    - `prefixes`: those that need no declaration.
    """

    store: Store
    graphs: Mapping[str, Path]
    prefixes: Mapping[str, str]

    @classmethod
    def load(cls, maps: Sequence[StoredMap], ontology: Iterable[Path] = ()) -> Dataset:
        """Read the ontology and its extensions, add the maps, and what follows from all of it."""
        store = Store()
        load_closed(store, tuple(ontology))
        definitions = Definitions.read(store)
        graphs: dict[str, Path] = {}
        names: set[str] = set()
        for stored in maps:
            name = graph_name(stored.folder, names)
            graphs[name] = stored.folder
            store.bulk_extend(_in_graph(stored, NamedNode(name)))
        classify(store, definitions, graphs)
        return cls(store, graphs, prefixes_for(maps))

    def ask(
        self,
        sparql: str,
        default_graphs: Sequence[str] = (),
        named_graphs: Sequence[str] = (),
        timeout_s: float | None = None,
    ) -> QueryResult:
        """The answer, read to its end, within `timeout_s` seconds (None: however long it takes).

        Other arguments and errors as of `answer`; `QueryError` also where the time is over.
        """

        def asked() -> QueryResult:
            found = self.answer(sparql, default_graphs, named_graphs)
            try:
                return QueryResult.read(found, self.prefixes)
            except OSError as error:
                raise QueryError(f"the query failed while it ran: {error}") from error

        return asked() if timeout_s is None else within(timeout_s, asked)

    def answer(
        self, sparql: str, default_graphs: Sequence[str] = (), named_graphs: Sequence[str] = ()
    ) -> Answer:
        """The answer as Oxigraph gives it, which writes itself as JSON, XML, CSV or TSV.

        `default_graphs`, `named_graphs`: IRIs; where either is given, they stand in for the query's
        own FROM and FROM NAMED, as the protocol's parameters do. `QueryError`, with line and
        column, for what can't be parsed, for updates and SERVICE, and for a graph that is not
        there.
        """
        refuse_writing(sparql)
        asked = [*default_graphs, *named_graphs]
        self._check_graphs(asked or graphs_named(sparql))
        return _answer(self.store, sparql, self.prefixes, default_graphs, named_graphs)

    def _check_graphs(self, asked: Iterable[str]) -> None:
        if not asked:
            return
        known = {str(graph.value) for graph in self.store.named_graphs()} | _ALWAYS_THERE
        for name in asked:
            if name not in known:
                raise QueryError(f"no graph <{name}> here; there are: {', '.join(sorted(known))}")


def dataset(maps: Sequence[StoredMap], ontology: Iterable[Path] = ()) -> Store:
    """Maps and ontology in one store, a named graph each, with what follows from them."""
    return Dataset.load(maps, ontology).store


def graph_name(folder: Path, taken: set[str]) -> str:
    """`urn:afkb:map:<folder>`; a second folder of the same name gets a number."""
    stem = name = map_graph(folder.resolve().name)
    number = 1
    while name in taken:
        number += 1
        name = f"{stem}-{number}"
    taken.add(name)
    return name


def prefixes_for(maps: Sequence[StoredMap]) -> dict[str, str]:
    """Prefixes that need no declaration; `scene:` is the first map's."""
    return dict(PREFIXES) | ({"scene": maps[0].base} if maps else {})


def _in_graph(stored: StoredMap, graph: NamedNode) -> Iterable[Quad]:
    for quad in stored.store:
        yield Quad(quad.subject, quad.predicate, quad.object, graph)


def _answer(
    store: Store,
    sparql: str,
    prefixes: Mapping[str, str],
    default_graphs: Sequence[str] = (),
    named_graphs: Sequence[str] = (),
) -> Answer:
    own = bool(default_graphs or named_graphs)
    try:
        return store.query(
            sparql,
            prefixes=dict(prefixes),
            # It would win over FROM.
            use_default_graph_as_union=not own and not names_its_dataset(sparql),
            default_graph=[NamedNode(name) for name in default_graphs] if own else None,
            named_graphs=[NamedNode(name) for name in named_graphs] if own else None,
        )
    except SyntaxError as error:
        raise syntax_error(sparql, error) from error
    except (ValueError, OSError, RuntimeError) as error:
        raise QueryError(f"the query can't be answered: {error}") from error
