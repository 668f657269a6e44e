"""A map read back from its folder: what `info`, `rooms` and `query` work on."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from pyoxigraph import DefaultGraph, Literal, NamedNode, RdfFormat, Store, parse

from afkb.errors import MapError
from afkb.store.vocabulary import FORMAT_VERSION, MAP_NODES, local_name, term

if TYPE_CHECKING:
    import rdflib

SCENE_FILE = "scene.ttl"
RUN_FILE = "run.json"


def load(folder: Path | str) -> StoredMap:
    """The map in a folder that `afkb map` wrote; `MapError` if there is none or it is broken."""
    folder = Path(folder).expanduser()
    path = folder / SCENE_FILE
    if not folder.exists():
        raise MapError(f"{folder}: no such map; `afkb map SOURCE --out {folder}` writes one")
    if not path.is_file():
        raise MapError(f"{folder}: not a map, it has no {SCENE_FILE}; see `afkb map --help`")
    try:
        return StoredMap(folder, read_scene(path.read_bytes()))
    except (SyntaxError, ValueError) as error:
        where = getattr(error, "lineno", None)
        at = f", line {where}" if where else ""
        raise MapError(
            f"{path}{at}: not readable as a map ({error.args[0]}); write it again"
        ) from error
    except OSError as error:
        raise MapError(f"{path}: {error.strerror or error}") from error


def read_scene(turtle: bytes) -> Store:
    """The statements of a scene in an in-memory Oxigraph store."""
    store = Store()
    store.extend(parse(turtle, format=RdfFormat.TURTLE))
    if not any(store.quads_for_pattern(None, term("rdf:type"), term("afn:TopologicalMap"))):
        raise ValueError("no afn:TopologicalMap in it")
    for quad in store.quads_for_pattern(None, term("afn:formatVersion"), None):
        if isinstance(quad.object, Literal) and int(quad.object.value) > FORMAT_VERSION:
            raise ValueError(f"format {quad.object.value} is newer than this afkb's; upgrade afkb")
    return store


@dataclass(frozen=True)
class StoredMap:
    """A scene's RDF with typed ways to ask it; ids are the local parts of the scene's IRIs."""

    folder: Path
    store: Store

    @cached_property
    def graph(self) -> rdflib.Graph:
        """The same statements through rdflib's API."""
        import rdflib

        graph = rdflib.Graph(store="Oxigraph")
        triples = self.store.dump(format=RdfFormat.N_TRIPLES, from_graph=DefaultGraph())
        return graph.parse(data=triples or b"", format="nt")

    @cached_property
    def base(self) -> str:
        """The namespace of the scene's things."""
        return self.instances("TopologicalMap")[0].value.rsplit("#", 1)[0] + "#"

    def instances(self, name: str) -> list[NamedNode]:
        """Everything of class `afn:<name>`, in order of id (`e2` before `e10`)."""
        quads = self.store.quads_for_pattern(None, term("rdf:type"), term(f"afn:{name}"))
        named = [q.subject for q in quads if isinstance(q.subject, NamedNode)]
        return sorted(named, key=lambda n: natural(local_name(n.value)))

    def values(self, node: NamedNode, predicate: str) -> Iterator[NamedNode | Literal]:
        """What the scene states of a thing."""
        for quad in self.store.quads_for_pattern(node, term(predicate), None):
            if isinstance(quad.object, NamedNode | Literal):
                yield quad.object

    def number(self, node: NamedNode, predicate: str, default: float = 0.0) -> float:
        """A number stated of a thing, or the default."""
        return next((float(v.value) for v in self.values(node, predicate)), default)

    def names(self, node: NamedNode, predicate: str) -> list[str]:
        """Local names (or texts) of what is stated, sorted."""
        found = [
            local_name(v.value) if isinstance(v, NamedNode) else v.value
            for v in self.values(node, predicate)
        ]
        return sorted(found, key=natural)

    def name(self, node: NamedNode, predicate: str) -> str | None:
        """The one thing that is stated, or None."""
        return next(iter(self.names(node, predicate)), None)

    def belief(self, node: NamedNode, kind: str, of: str) -> dict[str, float]:
        """A posterior `afn:<kind>Belief`, name to probability, the likeliest first."""
        found = {
            self.name(belief, f"afn:{of}") or "": self.number(belief, "afn:probability")
            for belief in self.values(node, f"afn:{kind}Belief")
            if isinstance(belief, NamedNode)
        }
        return dict(sorted(found.items(), key=lambda item: (-item[1], item[0])))

    def outline(self, node: NamedNode) -> list[list[float]] | None:
        """Its polygon or line, [[x, y], …] m in the map frame, or None."""
        for geometry in self.values(node, "geo:hasGeometry"):
            if isinstance(geometry, NamedNode):
                for wkt in self.values(geometry, "geo:asWKT"):
                    return points(wkt.value)
        return None

    @cached_property
    def kinds(self) -> dict[str, int]:
        """How many there are of each kind of node, and of bounds, doorways, rooms and edges."""
        counted = (*MAP_NODES, "Bound", "Doorway", "Room", "Edge", "LoopClosure")
        return {name: len(self.instances(name)) for name in counted}

    @cached_property
    def counts(self) -> dict[str, int]:
        """What the run counted: frames, skipped frames and so on."""
        found: Counter[str] = Counter()
        for node in self.instances("Count"):
            found[self.name(node, "rdfs:label") or ""] = int(self.number(node, "rdf:value"))
        return dict(sorted(found.items()))

    @cached_property
    def notes(self) -> list[str]:
        """What the run wants a reader to know."""
        return sorted(v.value for v in self.values(NamedNode(self.base + "map"), "rdfs:comment"))


def natural(name: str) -> tuple[str, int, str]:
    """A key that sorts names as people do: `e2` before `e10`."""
    stem = name.rstrip("0123456789")
    digits = name[len(stem) :]
    return stem, int(digits) if digits else -1, name


def points(wkt: str) -> list[list[float]]:
    """The corners [x, y] of a polygon or line in well-known text, the first not told twice."""
    inner = wkt[wkt.index("(") :].strip("() ")
    points = [[float(v) for v in pair.split()] for pair in inner.split(",")]
    closed = wkt.startswith("POLYGON") and len(points) > 1 and points[0] == points[-1]
    return points[:-1] if closed else points
