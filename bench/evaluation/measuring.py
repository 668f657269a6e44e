"""Runs a measurement's commands as they are printed, and keeps what they print."""

from __future__ import annotations

import os
import shlex
import subprocess
import sys
import tempfile
import time
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import date
from pathlib import Path

from bench.detectors.data import data_folder
from bench.evaluation.chapters import Measurement
from bench.evaluation.results import Result, machine

ROOT = Path(__file__).parents[2]


class NotMeasured(RuntimeError):
    """A command failed."""


def measured(asked: Measurement) -> Result:
    """Run it as often as it asks; raises `NotMeasured` with what it printed where it fails."""
    with tempfile.TemporaryDirectory() as scratch:
        environment = _environment()
        for line in asked.before:
            _run(line, Path(scratch), environment)
        runs = [_run(asked.command, Path(scratch), environment) for _ in range(asked.repeats)]
    return Result(
        command=asked.command,
        runs=tuple(run.lines for run in runs),
        seconds=round(max(run.seconds for run in runs), 1),
        memory_mb=round(max(run.memory_mb for run in runs)),
        revision=_revision(),
        date=date.today().isoformat(),
        machine=machine(),
    )


def _environment() -> Mapping[str, str]:
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    known = {"AFKB_DATA": str(data_folder().resolve()), "PYTHONPATH": str(ROOT), "COLUMNS": "110"}
    return os.environ | known | {"PATH": path, "NO_COLOR": "1"}


@dataclass(frozen=True, slots=True)
class _Run:
    """What one run printed, how long it took, and the most memory one of its processes had."""

    lines: tuple[str, ...]
    seconds: float
    memory_mb: float


def _run(line: str, folder: Path, environment: Mapping[str, str]) -> _Run:
    words = shlex.split(line.replace("$AFKB_DATA", environment["AFKB_DATA"]))
    said = folder / "said", folder / "errors"
    begun = time.perf_counter()
    with said[0].open("w") as out, said[1].open("w") as errors:
        try:
            process = subprocess.Popen(
                words, cwd=folder, env=environment, stdout=out, stderr=errors
            )
        except OSError as error:
            raise NotMeasured(f"{line}: {error.strerror}") from error
        _, status, usage = os.wait4(process.pid, 0)
    if os.waitstatus_to_exitcode(status) != 0:
        raise NotMeasured(f"{line}: {said[1].read_text().strip()[-500:]}")
    text = said[0].read_text().replace(environment["AFKB_DATA"], "$AFKB_DATA")
    lines = tuple(told.rstrip() for told in text.replace(str(folder), ".").strip().splitlines())
    return _Run(lines, time.perf_counter() - begun, usage.ru_maxrss / 1024)


def _revision() -> str:
    told = subprocess.run(
        ["git", "describe", "--always", "--dirty"], cwd=ROOT, capture_output=True, text=True
    )
    return told.stdout.strip() or "unknown"
