"""Puts a map into a server so that whoever asks there finds the old map or the new one, whole.

The statements are gathered in a graph aside, compared with what was sent, and only then put in the
map's place, by one update request that does nothing when it comes a second time. Each request may
be lost, or done without an answer, and is then sent again; a program that died goes on where it
stopped when it is run again.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from enum import StrEnum

from pyoxigraph import Literal, Triple

from afkb.errors import EndpointError
from afkb.fleet.catalogue import CATALOGUE, PROLOGUE, kept_maps, staged_for
from afkb.fleet.server import Server
from afkb.fleet.statements import digest_of, portions, statements_of
from afkb.store import StoredMap
from afkb.store.vocabulary import map_graph

ATTEMPTS = 3
"""How often a map is sent before what the server makes of it is told as an error."""


class PushState(StrEnum):
    """What became of a map that was to be kept by a server."""

    STORED = "stored"
    ALREADY_THERE = "already there"


@dataclass(frozen=True, slots=True)
class Pushed:
    """A map that a server keeps now: its name there, its graph, how many statements."""

    name: str
    graph: str
    triples: int
    state: PushState


@dataclass(frozen=True, slots=True)
class _Parcel:
    """What is sent, where to, and how it is known again."""

    name: str
    statements: Sequence[Triple]
    digest: str

    @property
    def graph(self) -> str:
        return map_graph(self.name)

    @property
    def staging(self) -> str:
        """Named after the content: whoever goes on with it finds what was sent before."""
        return f"{self.graph.replace(':map:', ':staging:', 1)}:{self.digest[:16]}"


def push(server: Server, stored: StoredMap, name: str) -> Pushed:
    """Have a server keep a map under a name; one of that name is replaced, in one step.

    Raises `EndpointError` where the server stays away, refuses, or keeps something else than
    was sent; what it kept before is then still there.
    """
    statements = statements_of(stored)
    parcel = _Parcel(name, statements, digest_of(statements))
    done = _done(parcel, PushState.ALREADY_THERE)
    if _is_listed(server, parcel):
        _clear(server, parcel)
        return done
    for _ in range(ATTEMPTS):
        _stage(server, parcel)
        if _holds(server, parcel.staging, parcel):
            server.update(put_in_place(parcel))
        else:
            _clear(server, parcel)
        if _holds(server, parcel.graph, parcel) and _is_listed(server, parcel):
            _clear(server, parcel)
            return _done(parcel, PushState.STORED)
    raise EndpointError(
        f"{server.update_at.url}: does not keep {stored.folder} as it was sent, after {ATTEMPTS} "
        f"tries ({server.count(parcel.graph)} statements, not {len(statements)}); does it limit "
        "answers or updates, or does someone else send a map of this name?"
    )


def _done(parcel: _Parcel, state: PushState) -> Pushed:
    return Pushed(parcel.name, parcel.graph, len(parcel.statements), state)


def _is_listed(server: Server, parcel: _Parcel) -> bool:
    """Whether the catalogue says that it is there, and as many statements are."""
    listed = any(k.graph == parcel.graph and k.sha256 == parcel.digest for k in kept_maps(server))
    return listed and server.count(parcel.graph) == len(parcel.statements)


def _holds(server: Server, graph: str, parcel: _Parcel) -> bool:
    return digest_of(server.triples(graph)) == parcel.digest


def _stage(server: Server, parcel: _Parcel) -> None:
    """Gather the statements aside; those that an earlier try brought there are not sent again."""
    there = server.count(parcel.staging)
    # Even if it is there: another who sends this map may have struck it off meanwhile.
    entry = f"<{parcel.staging}> dcterms:isVersionOf <{parcel.graph}>"
    server.update(f"{PROLOGUE}INSERT DATA {{ GRAPH <{CATALOGUE}> {{ {entry} }} }}")
    sent = 0
    for portion in portions(parcel.statements):
        sent += len(portion)
        if sent <= there < len(parcel.statements):
            continue
        text = "\n".join(portion)
        server.update(f"INSERT DATA {{ GRAPH <{parcel.staging}> {{\n{text}\n}} }}")


def put_in_place(parcel: _Parcel) -> str:
    """The update that makes what was gathered the map, and does nothing where nothing was.

    Every step asks for the statement that was gathered last. So it can be sent again when its
    answer was lost; and where a server that doesn't do a request as a whole dies between two
    steps, nothing is gone, and sending it again completes it.
    """
    whole = f"GRAPH <{parcel.staging}> {{ ?whole a afn:TopologicalMap }}"
    now = datetime.now(UTC).isoformat(timespec="seconds")
    entry = f"""<{parcel.graph}> a void:Dataset ; dcterms:title {Literal(parcel.name)} ;
        void:triples {len(parcel.statements)} ; afn:sha256 "{parcel.digest}" ;
        dcterms:modified "{now}"^^xsd:dateTime"""
    return f"""{PROLOGUE}
        DELETE {{ GRAPH <{parcel.graph}> {{ ?s ?p ?o }} }}
        WHERE {{ {whole} GRAPH <{parcel.graph}> {{ ?s ?p ?o }} }} ;
        INSERT {{ GRAPH <{parcel.graph}> {{ ?s ?p ?o }} }}
        WHERE {{ {whole} GRAPH <{parcel.staging}> {{ ?s ?p ?o }} }} ;
        DELETE {{ GRAPH <{CATALOGUE}> {{ <{parcel.graph}> ?p ?o }} }}
        WHERE {{ {whole} GRAPH <{CATALOGUE}> {{ <{parcel.graph}> ?p ?o }} }} ;
        INSERT {{ GRAPH <{CATALOGUE}> {{ {entry} }} }} WHERE {{ {whole} }} ;
        DROP SILENT GRAPH <{parcel.staging}>"""


def _clear(server: Server, parcel: _Parcel) -> None:
    """Drop what was gathered aside for this map, now or by programs that never came back."""
    for staged in dict.fromkeys([*staged_for(server, parcel.graph), parcel.staging]):
        server.update(
            f"{PROLOGUE}DROP SILENT GRAPH <{staged}> ; "
            f"DELETE WHERE {{ GRAPH <{CATALOGUE}> {{ <{staged}> dcterms:isVersionOf ?of }} }}"
        )
