"""Writes a map's RDF: of a stored map its very statements, else those that storing would make."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from pyoxigraph import RdfFormat, parse

from afkb.flow import TopologicalMap
from afkb.store.scene import scene_base, scene_triples
from afkb.store.scribe import Names
from afkb.store.turtle import to_turtle
from afkb_rdf.json_ld import to_json_ld

TURTLE, JSON_LD = "scene.ttl", "scene.jsonld"


class SceneWriter:
    """What both formats share: a map that is not stored yet is written by way of its Turtle."""

    in_map_folder = False

    def __init__(self, names: Names) -> None:
        self._names = names

    def export(
        self, topological_map: TopologicalMap, folder: Path, run: Mapping[str, object]
    ) -> Sequence[Path]:
        """Write the map's statements, with the parameters that `run` tells."""
        turtle = _turtle(topological_map, self._names, run)
        return self.export_scene(turtle, folder, run)

    def export_scene(
        self, turtle: bytes, folder: Path, run: Mapping[str, object]
    ) -> Sequence[Path]:
        """Write the statements of a stored scene, given as its Turtle."""
        raise NotImplementedError


class TurtleExporter(SceneWriter):
    """The map's RDF as Turtle: scene.ttl as it stands, for any triple store."""

    name = "turtle"

    def export_scene(
        self, turtle: bytes, folder: Path, run: Mapping[str, object]
    ) -> Sequence[Path]:
        """Write the same bytes; `run` is not used."""
        path = folder / TURTLE
        path.write_bytes(turtle)
        return [path]


class JsonLdExporter(SceneWriter):
    """The map's RDF as JSON-LD with a compact context: plain JSON to those who want that."""

    name = "json-ld"

    def export_scene(
        self, turtle: bytes, folder: Path, run: Mapping[str, object]
    ) -> Sequence[Path]:
        """Write the statements of a scene; `run` is not used."""
        path = folder / JSON_LD
        triples = (quad.triple for quad in parse(turtle, format=RdfFormat.TURTLE))
        path.write_text(to_json_ld(triples), encoding="utf-8")
        return [path]


def _turtle(whole: TopologicalMap, names: Names, run: Mapping[str, object]) -> bytes:
    base = scene_base(whole, names)
    return to_turtle(scene_triples(whole, base, names, run), base)
