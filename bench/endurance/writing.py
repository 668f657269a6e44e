"""The writing of a map folder alone, killed often: a process that replaces one map by another.

It writes the one, then the other, over and over, until it is killed; it is forked anew each time,
so that a kill costs no start.
"""

from __future__ import annotations

import argparse
import os
import signal
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path
from typing import Any, NoReturn

import numpy as np

from afkb.plugins.host import PluginHost
from afkb.store import load, write_map
from afkb.store.stored_map import read_map
from bench.endurance.killing import WORLD, digest, run_to_end


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add how often, and the random moments' seed."""
    parser.add_argument("--times", type=int, default=200, help="how often it is killed")
    parser.add_argument("--seed", type=int, default=0, help="of the random moments")


class Writer:
    """Writes two maps in turn into one folder, with all that is part of a map's folder."""

    def __init__(self, sources: list[Path], folder: Path) -> None:
        host = PluginHost()
        self.folder = folder
        self._names = host.knowledge_base
        self._exporters = [e for e in host.exporters() if e.in_map_folder]
        self._maps = [read_map(load(source)) for source in sources]

    def write(self, which: int) -> None:
        """Write the one or the other."""
        write_map(self.folder, self._maps[which], {}, self._exporters, self._names)

    def until_killed(self) -> NoReturn:
        """Write without end."""
        turn = 0
        while True:
            self.write(turn % 2)
            turn += 1


def run(args: argparse.Namespace) -> dict[str, Any]:
    """What stands in the folder after each kill."""
    with tempfile.TemporaryDirectory() as scratch:
        sources = [Path(scratch, "kept", name) for name in ("one", "other")]
        for source, stop in zip(sources, ("2", "6"), strict=True):
            run_to_end("map", WORLD, "--stop", stop, "--out", source)
        writer = Writer(sources, Path(scratch, "map"))
        return _killed_often(writer, args.times, np.random.default_rng(args.seed))


def _killed_often(writer: Writer, times: int, rng: np.random.Generator) -> dict[str, Any]:
    known, begun = {}, time.monotonic()
    for which in (0, 1):
        writer.write(which)
        known[digest(writer.folder)] = ("one", "other")[which]
    seconds = (time.monotonic() - begun) / 2
    found, left = Counter[str](), 0
    for moment in rng.uniform(0.0, 2 * seconds, times):
        _kill_after(float(moment), writer)
        stands = digest(writer.folder)
        found[known.get(stands, stands)] += 1
        left += any(writer.folder.parent.glob(".map.*"))
    writer.write(0)
    return {
        "kills": times,
        "writing_s": round(seconds, 3),
        "found": dict(found),
        "while_writing": left,
        "left_over": len(list(writer.folder.parent.glob(".map.*"))),
    }


def _kill_after(seconds: float, writer: Writer) -> None:
    sys.stdout.flush()
    child = os.fork()
    if not child:
        with suppress(BaseException):
            writer.until_killed()
        os._exit(1)
    time.sleep(seconds)
    os.kill(child, signal.SIGKILL)
    _, status = os.waitpid(child, 0)
    if not os.WIFSIGNALED(status):
        raise SystemExit("the writing failed without being killed")


def table(result: dict[str, Any]) -> Iterable[str]:
    """The result as lines."""
    yield f"killed {result['kills']} times while it wrote maps, {result['writing_s']} s each"
    for found, n in sorted(result["found"].items()):
        yield f"  afterwards {found}: {n}"
    yield f"a scratch folder was left {result['while_writing']} times"
    yield f"left over after the next write: {result['left_over']}"
