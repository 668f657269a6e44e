"""What a process that runs strangers' queries gives up before it reads the first."""

from __future__ import annotations

import math
import os
import resource
import sys
from pathlib import Path

from afkb.serving.limits import MB, Limits

_GROWN_MB = 64
"""A process that has kept this much more than at its start is replaced: what is freed is not given
back to the system, and two hungry queries should not add up."""


def seal(limits: Limits) -> None:
    """Give up opening anything and growing beyond the limit; for good, in this process.

    No file and no socket can be opened any more, whatever a query's text talks the engine into:
    `SERVICE` has no network, and no path is read. Standard streams go nowhere.
    """
    _silence()
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    resource.setrlimit(resource.RLIMIT_FSIZE, (0, 0))
    if sys.platform == "linux":
        most = _address_space() + limits.memory_mb * MB
        resource.setrlimit(resource.RLIMIT_AS, (most, most))
    resource.setrlimit(resource.RLIMIT_NOFILE, (0, 0))


def allow_processor_time(seconds: float) -> None:
    """Let this process compute for so long from now: a second rein, should nobody kill it."""
    used = resource.getrusage(resource.RUSAGE_SELF)
    most = math.ceil(used.ru_utime + used.ru_stime + seconds) + 1
    resource.setrlimit(resource.RLIMIT_CPU, (most, resource.getrlimit(resource.RLIMIT_CPU)[1]))


def has_grown(peak_at_start_kb: int) -> bool:
    """Whether a query has made the process so large that a fresh one should stand in for it."""
    return peak_kb() - peak_at_start_kb > _GROWN_MB * 1024


def peak_kb() -> int:
    """The most memory that the process ever held, kB."""
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak // 1024 if sys.platform == "darwin" else peak


def _silence() -> None:
    nowhere = os.open(os.devnull, os.O_RDWR)
    for stream in (0, 1, 2):
        os.dup2(nowhere, stream)
    os.close(nowhere)


def _address_space() -> int:
    """Bytes of address space that the process has now."""
    told = Path("/proc/self/statm").read_text(encoding="ascii")
    return int(told.split()[0]) * resource.getpagesize()
