"""Maps a recording in a process of its own and watches it: whatever it does, others go on."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import IO

from afkb_mapping.batch.job import Job, JobState, Outcome

RUNNER = "afkb_mapping.batch.runner"
"""The module that maps one recording."""
LOOK_EVERY_S = 0.2
"""How often the process is looked at: memory grows by some tens of MB in that time."""

_THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")
_LONGEST_TOLD = 300


def mapped(job: Job, memory_limit: int | None = None) -> Outcome:
    """What became of a recording; nothing that goes wrong with it is raised.

    `memory_limit`: bytes that it may hold in memory (as Linux tells; elsewhere no limit).
    """
    begun = time.monotonic()
    with tempfile.TemporaryFile() as said, tempfile.TemporaryFile() as told:
        process = _started(job, said, told)
        try:
            stopped = _watch(process, job, memory_limit, begun)
        finally:
            process.kill()
            process.wait()
            if process.stdin:
                process.stdin.close()
        seconds = round(time.monotonic() - begun, 2)
        if stopped is None and process.returncode == 0:
            return _outcome(job, seconds, _end_of(told))
        error = stopped or _how_it_ended(process.returncode, _end_of(said))
        return Outcome.of(job, JobState.FAILED, error=error, seconds=seconds)


def memory_limit_here() -> int | None:
    """Bytes that a task may use of what the Dask worker that runs it was given."""
    from distributed import get_worker

    worker = get_worker()
    limit = worker.memory_manager.memory_limit
    return int(limit / max(1, worker.state.nthreads)) if limit else None


def mapped_by_worker(job: Job) -> Outcome:
    """The same on a Dask worker, within its limit."""
    return mapped(job, memory_limit_here())


def _started(job: Job, said: IO[bytes], told: IO[bytes]) -> subprocess.Popen[bytes]:
    """In a session of its own: Ctrl-C is for the batch, which then ends what it started."""
    process = subprocess.Popen(
        [sys.executable, "-m", RUNNER],
        stdin=subprocess.PIPE,
        stdout=told,
        stderr=said,
        env=os.environ | dict.fromkeys(_THREADS, str(job.threads)),
        start_new_session=True,
    )
    assert process.stdin is not None
    try:
        process.stdin.write(json.dumps(job.as_json()).encode() + b"\n")
        process.stdin.flush()
    except BrokenPipeError:
        process.wait()
    return process


def _watch(
    process: subprocess.Popen[bytes], job: Job, memory_limit: int | None, begun: float
) -> str | None:
    """Wait for its end; why it was stopped, or None where it ended by itself."""
    while True:
        try:
            process.wait(LOOK_EVERY_S)
            return None
        except subprocess.TimeoutExpired:
            if memory_limit and _memory(process.pid) > memory_limit:
                megabytes = memory_limit / 1e6
                return (
                    f"took more than {megabytes:.0f} MB of memory and was stopped; give it more "
                    "(--memory-limit, or fewer --workers), or take fewer frames (--stride)"
                )
            if job.seconds and time.monotonic() - begun > job.seconds:
                return f"took more than {job.seconds:g} s and was stopped (--time-limit)"


def _memory(process: int) -> int:
    """Bytes that it holds in memory, as Linux tells; 0 elsewhere, or when it has ended."""
    try:
        pages = int(Path(f"/proc/{process}/statm").read_text().split()[1])
    except (OSError, IndexError, ValueError):
        return 0
    return pages * os.sysconf("SC_PAGE_SIZE")


def _outcome(job: Job, seconds: float, last: str) -> Outcome:
    try:
        facts = json.loads(last)
        state = JobState.RESUMED if job.settings.resume else JobState.MAPPED
        state = JobState.FAILED if "error" in facts else state
        return Outcome.of(job, state, seconds=seconds, **facts)
    except (ValueError, TypeError):
        error = f"ended without a result ({last[:_LONGEST_TOLD]!r})"
        return Outcome.of(job, JobState.FAILED, error=error, seconds=seconds)


def _how_it_ended(code: int, last: str) -> str:
    if code < 0:
        name = signal.Signals(-code).name
        hint = "; was memory short?" if code == -signal.SIGKILL else ""
        return f"its process was ended by {name}{hint}"
    return f"its process ended with code {code}: {last[:_LONGEST_TOLD]}"


def _end_of(file: IO[bytes]) -> str:
    """The last line that was written."""
    file.seek(0, os.SEEK_END)
    file.seek(max(0, file.tell() - 65536))
    lines = file.read().decode("utf-8", "replace").strip().splitlines()
    return lines[-1] if lines else ""
