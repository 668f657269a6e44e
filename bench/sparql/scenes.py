"""A fleet of homes of some size: maps, and copies of them under other names, until it is enough."""

from __future__ import annotations

import argparse
import math
import statistics
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from pyoxigraph import NamedNode, Quad, Store

from afkb.plugins.host import PluginHost
from afkb.store import StoredMap, load
from afkb.store.vocabulary import SCENES
from afkb_mapping.run import make_map
from afkb_mapping.run_record import Settings

TRIPLES = 20_000
"""At least so many statements of scenes, the ontology not counted."""
REPEATS = 21
WORLD = "world:paper_home"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The maps, how large the fleet gets, and how often each question is asked."""
    parser.add_argument("maps", nargs="*", type=Path, metavar="MAP", help="folders of maps")
    parser.add_argument("--triples", type=int, default=TRIPLES)
    parser.add_argument("--repeats", type=int, default=REPEATS)


@contextmanager
def folders_of(args: argparse.Namespace) -> Iterator[list[Path]]:
    """The maps that are named, or a fresh one of the bundled home."""
    if args.maps:
        yield args.maps
        return
    with TemporaryDirectory() as scratch:
        out = Path(scratch) / "paper_home"
        make_map(PluginHost(), Settings(uri=WORLD, out=out))
        yield [out]


def fleet(folders: Sequence[Path], triples: int) -> list[StoredMap]:
    """The maps, and copies whose nodes have names of their own, until there are so many triples."""
    maps = [load(folder) for folder in folders]
    found = list(maps)
    while sum(len(one.store) for one in found) < triples:
        number = len(found)
        found.append(_copy(maps[number % len(maps)], f"{SCENES}copy-{number}#", number))
    return found


def _copy(stored: StoredMap, base: str, number: int) -> StoredMap:
    store = Store()
    old = stored.base

    def renamed(term: Any) -> Any:
        if isinstance(term, NamedNode) and term.value.startswith(old):
            return NamedNode(base + term.value[len(old) :])
        return term

    store.extend(Quad(renamed(q.subject), q.predicate, renamed(q.object)) for q in stored.store)
    return StoredMap(stored.folder.with_name(f"{stored.folder.name}-{number}"), store)


def timed(act: Callable[[], Any], repeats: int) -> dict[str, float]:
    """Milliseconds, of CPU of this process and of the clock; the first time is not counted."""
    cpu, wall = [], []
    for _ in range(repeats + 1):
        cpu_start, start = time.process_time(), time.perf_counter()
        act()
        cpu.append((time.process_time() - cpu_start) * 1000)
        wall.append((time.perf_counter() - start) * 1000)
    return _spread(cpu[1:], "cpu") | _spread(wall[1:], "wall")


def _spread(values: list[float], name: str) -> dict[str, float]:
    ordered = sorted(values)
    return {
        f"{name}_median_ms": round(statistics.median(ordered), 4),
        f"{name}_p95_ms": round(ordered[math.ceil(0.95 * len(ordered)) - 1], 4),
        f"{name}_least_ms": round(ordered[0], 4),
    }
