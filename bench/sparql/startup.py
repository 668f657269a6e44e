"""`afkb query` as a whole command: from the shell and back, on one map.

    python -m bench.sparql startup [MAP] [--repeats N]

CPU is what the command and its children took; the clock depends on what else the machine does.
"""

from __future__ import annotations

import argparse
import resource
import statistics
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from bench.sparql.scenes import add_arguments, folders_of

__all__ = ["add_arguments", "run", "table"]
MOST = 9
"""Runs; a command takes a second or so."""


def run(args: argparse.Namespace) -> dict[str, Any]:
    """CPU and clock, ms, of the command, of its help, and of Python itself."""
    with folders_of(args) as folders:
        repeats = min(args.repeats, MOST)
        cli = ["-m", "afkb.cli.app"]
        return {
            "afkb query MAP @room-purposes": _command(
                [*cli, "query", folders[0], "@room-purposes"], repeats
            ),
            "afkb query --help": _command([*cli, "query", "--help"], repeats),
            "python -c pass": _command(["-c", "pass"], repeats),
        }


def _command(arguments: Sequence[str | Path], repeats: int) -> dict[str, float]:
    cpu, wall = [], []
    for _ in range(repeats + 1):
        before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
        subprocess.run([sys.executable, *arguments], check=True, capture_output=True)
        wall.append((time.perf_counter() - start) * 1000)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        cpu.append((after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime) * 1000)
    return {
        "cpu_median_ms": round(statistics.median(cpu[1:])),
        "cpu_least_ms": round(min(cpu[1:])),
        "cpu_most_ms": round(max(cpu[1:])),
        "wall_median_ms": round(statistics.median(wall[1:])),
    }


def table(result: dict[str, Any]) -> Iterator[str]:
    """A line a command."""
    for name, ms in result.items():
        yield (
            f"{name:32} {ms['cpu_median_ms']:6} ms of CPU "
            f"({ms['cpu_least_ms']} to {ms['cpu_most_ms']}), {ms['wall_median_ms']} of the clock"
        )
