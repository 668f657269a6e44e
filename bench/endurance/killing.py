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


@dataclass(frozen=True, slots=True)
class Moment:
    """Seconds after the start, or after it was first seen to write: a busy machine shifts that."""

    after_s: float
    from_writing: bool = False


@dataclass(frozen=True, slots=True)
class Timing:
    """How long a run takes, and from when on it writes, s."""

    whole_s: float
    writes_from_s: float

    def moments(self, times: int, rng: np.random.Generator) -> list[Moment]:
        """When to kill it: half of the moments anywhere, half while it writes or just after."""
        writing = 1.1 * (self.whole_s - self.writes_from_s)
        half = times // 2
        anywhere = [Moment(float(t)) for t in rng.uniform(0.0, self.whole_s, times - half)]
        return anywhere + [Moment(float(t), True) for t in rng.uniform(0.0, writing, half)]


def timed(command: Sequence[str], folders: Sequence[Path]) -> Timing:
    """A run to its end, watched: it writes from when a scratch folder beside a map holds a file."""
    begun = time.monotonic()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _until_it_writes(process, folders)
    writes_from = time.monotonic() - begun
    if process.wait():
        raise SystemExit(f"{' '.join(command)}: failed without being killed")
    return Timing(time.monotonic() - begun, writes_from)


def _until_it_writes(process: subprocess.Popen[bytes], folders: Sequence[Path]) -> None:
    while process.poll() is None and not _is_writing(folders):
        time.sleep(0.002)


def _is_writing(folders: Sequence[Path]) -> bool:
    """Whether a scratch folder holds a file; an empty one is a look whether it can be written."""
    for folder in folders:
        for scratch in folder.parent.glob(f".{folder.name}.*.partial"):
            with suppress(FileNotFoundError):
                if any(scratch.iterdir()):
                    return True
    return False


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
    if moment.from_writing:
        _until_it_writes(process, folders)
    with suppress(subprocess.TimeoutExpired):
        process.wait(moment.after_s)
    started = descendants(process.pid)
    had_ended = process.poll() is not None
    with suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGKILL)
    process.wait()
    gone_after = _gone(started)
    return Killed(moment, had_ended, _is_writing(folders), gone_after)


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
