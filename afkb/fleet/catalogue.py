"""Which maps a server keeps: a graph of its own lists them, changed in the same step as they."""

from __future__ import annotations

from dataclasses import dataclass

from afkb.errors import MapError
from afkb.fleet.server import Server
from afkb.store.vocabulary import PREFIXES, map_graph

CATALOGUE = "urn:afkb:maps"
"""The graph that lists the maps."""

PROLOGUE = "".join(
    f"PREFIX {name}: <{iri}>\n"
    for name, iri in {**PREFIXES, "void": "http://rdfs.org/ns/void#"}.items()
    if name in ("afn", "dcterms", "rdf", "xsd", "void")
)


@dataclass(frozen=True, slots=True)
class KeptMap:
    """A map in a server: its name, its graph, how many statements, their SHA-256, since when.

    `since`: as the server has it, ISO 8601, UTC.
    """

    name: str
    graph: str
    triples: int
    sha256: str
    since: str


def kept_maps(server: Server) -> list[KeptMap]:
    """The maps that a server keeps, by name."""
    rows = server.ask(f"""{PROLOGUE}
        SELECT ?name ?graph ?triples ?sha256 ?since WHERE {{ GRAPH <{CATALOGUE}> {{
          ?graph a void:Dataset ; dcterms:title ?name ; void:triples ?triples ;
                 afn:sha256 ?sha256 ; dcterms:modified ?since }} }}""")
    found = [
        KeptMap(r["name"], r["graph"], int(r["triples"]), r["sha256"], r["since"]) for r in rows
    ]
    return sorted(found, key=lambda kept: kept.name)


def remove(server: Server, name: str) -> KeptMap:
    """Take a map out of a server; `MapError` where it keeps none of that name."""
    known = {kept.name: kept for kept in kept_maps(server)}
    if name not in known:
        names = ", ".join(known) or "none"
        raise MapError(f"{server.query_at.url}: keeps no map {name!r}; it keeps: {names}")
    graph = map_graph(name)
    staged = "".join(f"DROP SILENT GRAPH <{s}> ;\n" for s in staged_for(server, graph))
    server.update(f"""{PROLOGUE}{staged}DROP SILENT GRAPH <{graph}> ;
        DELETE WHERE {{ GRAPH <{CATALOGUE}> {{ <{graph}> ?p ?o }} }} ;
        DELETE {{ GRAPH <{CATALOGUE}> {{ ?staged ?p ?o }} }}
        WHERE {{ GRAPH <{CATALOGUE}> {{ ?staged dcterms:isVersionOf <{graph}> ; ?p ?o }} }}""")
    return known[name]


def staged_for(server: Server, graph: str) -> list[str]:
    """Graphs in which a new version of a map is or was being gathered."""
    rows = server.ask(f"""{PROLOGUE}
        SELECT ?staged WHERE {{ GRAPH <{CATALOGUE}> {{ ?staged dcterms:isVersionOf <{graph}> }} }}
        ORDER BY ?staged""")
    return [row["staged"] for row in rows]
