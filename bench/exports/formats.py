"""Each format: bytes, CPU time to write, and CPU time of the tool that it is for to read it.

python -m bench.exports formats [MAP...] [--repeats N]
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from afkb.plugins.host import PluginHost
from afkb.store import load
from afkb.store.stored_grid import read_grid
from afkb_mapping.exporting.export import export_map, formats
from bench.exports.maps import add_arguments, maps_of, timed, told

__all__ = ["add_arguments", "run", "table"]


def run(args: argparse.Namespace) -> dict[str, Any]:
    """By map and format: bytes, and milliseconds to write and to read."""
    host = PluginHost()
    with maps_of(args) as maps:
        return {name: _of_map(folder, host, args.repeats) for name, folder in maps.items()}


def _of_map(folder: Path, host: PluginHost, repeats: int) -> dict[str, Any]:
    found: dict[str, Any] = {"nodes": _nodes(folder)}
    for format_ in formats(host):
        with TemporaryDirectory() as scratch:
            act = partial(export_map, folder, format_.name, Path(scratch), None, True, host)
            files = act()
            read = READERS.get(format_.name)
            found[format_.name] = {
                "bytes": sum(f.stat().st_size for f in files),
                "write": timed(act, repeats),
                "read": timed(partial(read, files), repeats) if read else None,
            }
    return found


def _nodes(folder: Path) -> int:
    kinds = load(folder).kinds
    return sum(n for kind, n in kinds.items() if kind not in ("Edge", "LoopClosure"))


def _networkx(files: list[Path]) -> object:
    import networkx as nx

    return nx.read_graphml(files[0])


def _spark_dsg(files: list[Path]) -> object:
    import spark_dsg

    return spark_dsg.DynamicSceneGraph.load(str(files[0]))


def _gdal(files: list[Path]) -> object:
    import pyogrio

    return pyogrio.raw.read(files[0])


def _oxigraph(files: list[Path]) -> object:
    import pyoxigraph

    store = pyoxigraph.Store()
    kind = pyoxigraph.RdfFormat.from_extension(files[0].suffix.removeprefix("."))
    store.extend(pyoxigraph.parse(path=files[0], format=kind))
    return store


def _csv(files: list[Path]) -> object:
    import csv

    return [list(csv.reader(f.open(newline=""))) for f in files if f.suffix == ".csv"]


def _grid(files: list[Path]) -> object:
    return read_grid(files[0].parent)


READERS: dict[str, Callable[[list[Path]], object]] = {
    "csv": _csv,
    "geojson": _gdal,
    "graphml": _networkx,
    "json-ld": _oxigraph,
    "nav2": _grid,
    "spark-dsg": _spark_dsg,
    "turtle": _oxigraph,
}
"""Format to the tool that reads it; what a person looks at has none."""


def table(result: dict[str, Any]) -> Iterator[str]:
    """A line a format."""
    for name, found in result.items():
        nodes = found["nodes"]
        yield f"{name}: {nodes} nodes; medians (least to greatest)"
        yield f"  {'':10} {'kB':>8} {'bytes/node':>11}   write, and read by its tool"
        for format_, told_of in found.items():
            if format_ != "nodes":
                size = told_of["bytes"]
                line = f"  {format_:10} {size / 1e3:8.1f} {size / nodes:11.0f} "
                read = told(told_of["read"]) if told_of["read"] else ""
                yield f"{line} {told(told_of['write'])} {read}"
