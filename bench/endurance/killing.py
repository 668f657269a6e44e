"""Starts commands, kills them at a moment, and tells what they left."""

from __future__ import annotations

import argparse
import hashlib
import os
import signal
import subprocess
import sys
import time
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path

import numpy as np

from afkb.errors import MapError
from afkb.store import load

WORLD = "world:paper_home"
GONE_WITHIN_S = 30.0
"""How long processes that a killed one had started may take to end; the table tells how long they
took."""


def afkb(*arguments: str | Path) -> list[str]:
    """The command line as this Python runs it."""
    return [sys.executable, "-m", "afkb.cli.app", *map(str, arguments)]


def run_to_end(*arguments: str | Path) -> float:
    """Run a command to its end; seconds that took."""
    begun = time.monotonic()
    subprocess.run(afkb(*arguments), check=True, capture_output=True)
    return time.monotonic() - begun


class Phase(StrEnum):
    """What a run is seen to begin: itself, the files of its map, or to put them in place."""

    START = "start"
    WRITING = "writing"
    PLACING = "placing"


PLACING_S = 0.3
"""How long after a map's last file is begun it may take to be synced and put in place, s."""
_LAST_FILE = "run.json"


@dataclass(frozen=True, slots=True)
class Moment:
    """Seconds after a phase was seen to begin: a busy machine shifts when that is."""

    after_s: float
    phase: Phase = Phase.START


@dataclass(frozen=True, slots=True)
class Timing:
    """How long a run takes, and from when on it writes, s."""

    whole_s: float
    writes_from_s: float

    def moments(self, times: int, rng: np.random.Generator) -> list[Moment]:
        """When to kill it: half of the moments anywhere, a quarter in each of the last phases."""
        lasts = {
            Phase.START: (times - 2 * (times // 4), self.whole_s),
            Phase.WRITING: (times // 4, self.whole_s - self.writes_from_s),
            Phase.PLACING: (times // 4, PLACING_S),
        }
        return [
            Moment(float(after_s), phase)
            for phase, (n, seconds) in lasts.items()
            for after_s in rng.uniform(0.0, seconds, n)
        ]


def timed(command: Sequence[str], folders: Sequence[Path]) -> Timing:
    """A run to its end, watched."""
    begun = time.monotonic()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _wait_for(Phase.WRITING, process, folders)
    writes_from = time.monotonic() - begun
    if process.wait():
        raise SystemExit(f"{' '.join(command)}: failed without being killed")
    return Timing(time.monotonic() - begun, writes_from)


def _wait_for(phase: Phase, process: subprocess.Popen[bytes], folders: Sequence[Path]) -> None:
    """Wait until any of the folders' maps is in that phase, or the process has ended."""
    while process.poll() is None and phase not in _phases(folders):
        time.sleep(0.002)


def _phases(folders: Sequence[Path]) -> set[Phase]:
    """The phases that can be seen: an empty scratch folder is a look whether one can write."""
    seen = {Phase.START}
    for folder in folders:
        for scratch in folder.parent.glob(f".{folder.name}.*.partial"):
            with suppress(FileNotFoundError):
                names = {entry.name for entry in scratch.iterdir()}
                seen |= {Phase.WRITING} if names else set()
                seen |= {Phase.PLACING} if _LAST_FILE in names else set()
    return seen


@dataclass(frozen=True, slots=True)
class Killed:
    """What one kill left.

    `had_ended`: it came too late. `was_writing`: a scratch folder with something in it was left.
    `gone_after_s`: how long processes that it had started lived on; None where they still do.
    """

    moment: Moment
    had_ended: bool
    was_writing: bool
    gone_after_s: float | None
    found: str = ""


def kill_at(command: Sequence[str], moment: Moment, folders: Sequence[Path]) -> Killed:
    """Start a command, kill it and its process group at a moment, and wait for its children."""
    process = subprocess.Popen(
        command,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,
    )
    _wait_for(moment.phase, process, folders)
    with suppress(subprocess.TimeoutExpired):
        process.wait(moment.after_s)
    started = descendants(process.pid)
    had_ended = process.poll() is not None
    with suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGKILL)
    process.wait()
    gone_after = _gone(started)
    return Killed(moment, had_ended, Phase.WRITING in _phases(folders), gone_after)


def descendants(process: int) -> set[int]:
    """Processes that it started, and that these started, as Linux tells."""
    parents: dict[int, list[int]] = {}
    for stat in Path("/proc").glob("[0-9]*/stat"):
        with suppress(OSError, ValueError, IndexError):
            after_name = stat.read_text().rsplit(")", 1)[1].split()
            parents.setdefault(int(after_name[1]), []).append(int(stat.parent.name))
    found: set[int] = set()
    wanted = [process]
    while wanted:
        children = parents.get(wanted.pop(), [])
        found.update(children)
        wanted += children
    return found


def _gone(processes: set[int]) -> float | None:
    begun = time.monotonic()
    while any(_lives(process) for process in processes):
        if time.monotonic() - begun > GONE_WITHIN_S:
            return None
        time.sleep(0.02)
    return time.monotonic() - begun


def _lives(process: int) -> bool:
    try:
        state = Path(f"/proc/{process}/stat").read_text().rsplit(")", 1)[1].split()[0]
    except (OSError, IndexError):
        return False
    return state != "Z"


def digest(folder: Path) -> str:
    """SHA-256 of all of a map folder but run.json; says so where it can't be loaded."""
    if not folder.exists():
        return "nothing"
    try:
        load(folder)
    except MapError as error:
        return f"broken: {error}"
    found = hashlib.sha256()
    for path in sorted(folder.rglob("*")):
        if path.is_file() and path.name != "run.json":
            found.update(path.relative_to(folder).as_posix().encode() + b"\0")
            found.update(hashlib.sha256(path.read_bytes()).digest())
    return found.hexdigest()


def add_times(parser: argparse.ArgumentParser) -> None:
    """Add the options that all parts have."""
    parser.add_argument("--times", type=int, default=25, help="how often it is killed")
    parser.add_argument("--seed", type=int, default=0, help="of the random moments")
