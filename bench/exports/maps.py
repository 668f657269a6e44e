"""The maps that are weighed: those named, else fresh ones of what recordings there are."""

from __future__ import annotations

import argparse
import statistics
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from afkb.plugins.host import PluginHost
from afkb_mapping.run import make_map
from afkb_mapping.run_record import Settings
from bench.detectors.data import data_folder

WORLD = "world:paper_home"
HOMES = ("merom", "pomaria")
REPEATS = 9
"""Odd, so that the median is one of them; the first, with cold caches, is not counted."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The maps, and how often each thing is timed."""
    parser.add_argument("maps", nargs="*", type=Path, metavar="MAP", help="folders of maps")
    parser.add_argument("--repeats", type=int, default=REPEATS)


@contextmanager
def maps_of(args: argparse.Namespace) -> Iterator[dict[str, Path]]:
    """Name to folder of each map."""
    if args.maps:
        yield {folder.name: folder for folder in args.maps}
        return
    with TemporaryDirectory() as scratch:
        host, made = PluginHost(), {}
        for name, source in _sources().items():
            made[name] = Path(scratch) / name
            make_map(host, Settings(uri=source, out=made[name]))
        yield made


def _sources() -> dict[str, str]:
    bags = {home: data_folder() / "homes" / home / "bag" for home in HOMES}
    return {"paper_home": WORLD} | {n: str(bag) for n, bag in bags.items() if bag.exists()}


def timed(act: Callable[[], Any], repeats: int) -> dict[str, float]:
    """Milliseconds of CPU: median, least and greatest of the repeats after the first."""
    taken = []
    for _ in range(repeats + 1):
        start = time.process_time()
        act()
        taken.append((time.process_time() - start) * 1000)
    rest = taken[1:]
    return {"median_ms": statistics.median(rest), "least_ms": min(rest), "most_ms": max(rest)}


def told(ms: dict[str, float]) -> str:
    """A time with its spread."""
    return f"{ms['median_ms']:8.1f} ms ({ms['least_ms']:.1f} to {ms['most_ms']:.1f})"
