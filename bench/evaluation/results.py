"""What a measurement gave, kept as a file: its lines, run by run, and on what machine."""

from __future__ import annotations

import json
import os
import platform
import re
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from statistics import median

FOLDER = Path(__file__).parents[1] / "results"
_NUMBER = re.compile(r"(?<![\w.])\d+(?:\.\d+)?(?![\w.]*\d)")


@dataclass(frozen=True, slots=True)
class Result:
    """`runs`: the lines that each run printed. `seconds`, `memory_mb`: of the longest, the largest.

    `revision`: of the code; `date`: ISO 8601. `machine`: processor, cores, memory, Python.
    """

    command: str
    runs: tuple[tuple[str, ...], ...]
    seconds: float
    memory_mb: float
    revision: str
    date: str
    machine: str

    def save(self, name: str, folder: Path = FOLDER) -> Path:
        """Write it as `NAME.json`, whole or not at all."""
        folder.mkdir(parents=True, exist_ok=True)
        scratch = folder / f".{name}.json"
        scratch.write_text(json.dumps(asdict(self), indent=1) + "\n", encoding="utf-8")
        return scratch.replace(folder / f"{name}.json")

    @classmethod
    def load(cls, name: str, folder: Path = FOLDER) -> Result | None:
        """The result of that name, or None where it was not measured."""
        path = folder / f"{name}.json"
        if not path.is_file():
            return None
        kept = json.loads(path.read_text(encoding="utf-8"))
        return cls(**kept | {"runs": tuple(tuple(run) for run in kept["runs"])})


def machine() -> str:
    """Processor, cores, memory and Python of this machine."""
    info = Path("/proc/cpuinfo")
    text = info.read_text(encoding="utf-8") if info.is_file() else ""
    named = re.search(r"model name\s*: (.+)", text)
    memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 2**30
    processor = named[1].strip() if named else platform.machine()
    python = platform.python_version()
    return f"{processor}, {os.cpu_count()} cores, {memory:.0f} GiB, Python {python}"


def spread(runs: Sequence[Sequence[str]]) -> str:
    """By how much figures differ between runs, as a line; empty for one run.

    A figure's spread is its range over the runs, in hundredths of its median. Figures are compared
    in the order in which they are printed.
    """
    if len(runs) < 2:
        return ""
    columns = [[float(n) for line in run for n in _NUMBER.findall(line)] for run in runs]
    if len({len(column) for column in columns}) != 1:
        return f"{len(runs)} runs, which printed different lines."
    ranges = [
        (max(figures) - min(figures)) / median(figures)
        for figures in zip(*columns, strict=True)
        if median(figures) > 0
    ]
    moved = [r for r in ranges if r > 0]
    if not moved:
        return f"{len(runs)} runs, the same figures each time."
    half, most = (f"{100 * share:.0f} %" for share in (median(moved), max(moved)))
    return (
        f"{len(runs)} runs, of which the first is shown; {len(moved)} of {len(ranges)} figures "
        f"differ between them, half of these by less than {half}, one by {most}."
    )
