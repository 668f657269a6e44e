"""Size and CPU time to load of a map as we keep it and as spark-dsg keeps the same graph.

    python -m bench.exports peers [MAP...] [--repeats N]

The scene graph is exported from the map, then saved by spark_dsg itself, as JSON and in its binary
form. It has the same things, places and rooms, with beliefs and affordances, and the ways, supports
and anchors of predictions between them. It lacks walls, doorways, distances to obstacles, what
each belief rests on, and the ontology's words: that is what the RDF has more of. `map.json` is the
nearest to it of our own files. Loading the RDF means: ready to be asked in SPARQL.
"""

from __future__ import annotations

import argparse
import gzip
import json
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from afkb.plugins.host import PluginHost
from afkb.store import load
from afkb.store.stored_map import read_map
from afkb_mapping.exporting.export import export_map
from bench.detectors.data import NoData
from bench.exports.maps import add_arguments, maps_of, timed, told

__all__ = ["add_arguments", "run", "table"]


def run(args: argparse.Namespace) -> dict[str, Any]:
    """By map and form: bytes, packed bytes, milliseconds to load; raises `NoData` without peer."""
    try:
        import spark_dsg  # noqa: F401 - asked for before any map is made
    except ImportError as error:
        raise NoData(
            "spark_dsg is not installed: pip install -c constraints.txt -e '.[bench]'"
        ) from error
    host = PluginHost()
    with maps_of(args) as maps:
        return {name: _of_map(folder, host, args.repeats) for name, folder in maps.items()}


def _of_map(folder: Path, host: PluginHost, repeats: int) -> dict[str, Any]:
    import spark_dsg

    scene, summary = folder / "scene.ttl", folder / "map.json"
    with TemporaryDirectory() as scratch:
        (ours,) = export_map(folder, "spark-dsg", Path(scratch, "ours.json"), host=host)
        graph = spark_dsg.DynamicSceneGraph.load(str(ours))
        theirs = Path(scratch, "theirs.json")
        graph.save(str(theirs), False)
        binary = graph.to_binary(False)

        def spark(path: Path) -> Any:
            return spark_dsg.DynamicSceneGraph.load(str(path))

        return {
            "nodes in both": graph.num_nodes() - 1,
            "scene.ttl, to be asked in SPARQL": _form(
                scene.read_bytes(), lambda: load(folder), repeats
            ),
            "the folder, as a TopologicalMap": _form(
                scene.read_bytes(), lambda: read_map(load(folder)), repeats
            ),
            "map.json": _form(
                summary.read_bytes(), lambda: json.loads(summary.read_text()), repeats
            ),
            "spark-dsg JSON, written by us": _form(ours.read_bytes(), lambda: spark(ours), repeats),
            "spark-dsg JSON, by spark_dsg": _form(
                theirs.read_bytes(), lambda: spark(theirs), repeats
            ),
            "spark-dsg binary": _form(
                binary, lambda: spark_dsg.DynamicSceneGraph.from_binary(binary), repeats
            ),
        }


def _form(content: bytes, act: Any, repeats: int) -> dict[str, Any]:
    packed = len(gzip.compress(content, mtime=0))
    return {"bytes": len(content), "packed": packed, "load": timed(act, repeats)}


def table(result: dict[str, Any]) -> Iterator[str]:
    """A line a form."""
    for name, found in result.items():
        yield f"{name}: {found['nodes in both']} things, places and rooms in both"
        yield f"  {'':34} {'kB':>8} {'gzip kB':>8}   load, median (least to greatest)"
        for form, of in found.items():
            if isinstance(of, dict):
                sizes = f"{of['bytes'] / 1e3:8.1f} {of['packed'] / 1e3:8.1f}"
                yield f"  {form:34} {sizes} {told(of['load'])}"
