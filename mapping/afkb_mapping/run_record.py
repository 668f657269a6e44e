"""What run.json holds: what was asked, with what, how it went, and where the time was spent."""

from __future__ import annotations

import platform
import resource
import signal
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from importlib.metadata import version
from pathlib import Path

from afkb import __version__
from afkb.flow import LoopProposal, SkippedFrame, TopologicalMap
from afkb_mapping.memory.visit import Visit
from afkb_mapping.selection import FrameRange

RECORDED_PACKAGES = (
    "gtsam",
    "numpy",
    "numba",
    "open3d-cpu",
    "opencv-python-headless",
    "pgmpy",
    "rosbags",
)
MAX_LISTED_SKIPS = 20


@dataclass(frozen=True, slots=True)
class Settings:
    """What a run is asked to do; all of it is recorded in run.json.

    `view`: viewers that show the map while it is made, `NAME` or `NAME=TARGET`; they change nothing
    in it. `resume`: go on where an interrupted run to `out` stopped. `update`: `out` is the map of
    an earlier visit; `hours_later` than that this one is, None where the stamps are to tell.
    """

    uri: str
    out: Path
    detectors: tuple[str, ...] = ()
    predictors: tuple[str, ...] = ()
    mapper: str = "affordance"
    rule: str = "log-odds"
    start: int = 0
    stop: int | None = None
    stride: int = 1
    options: dict[str, str] = field(default_factory=dict)
    resume: bool = False
    update: bool = False
    hours_later: float | None = None
    view: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "out", self.out.expanduser())

    @property
    def frames(self) -> FrameRange:
        """Which frames of the recording are used."""
        return FrameRange(self.start, self.stop, self.stride)


@dataclass(slots=True)
class Stages:
    """Seconds spent per stage of the run."""

    seconds: dict[str, float] = field(default_factory=dict)

    @contextmanager
    def timed(self, stage: str) -> Iterator[None]:
        """Add the time of the block to a stage."""
        begun = time.perf_counter()
        try:
            yield
        finally:
            spent = time.perf_counter() - begun
            self.seconds[stage] = self.seconds.get(stage, 0.0) + spent


def run_record(
    settings: Settings,
    stages: Stages,
    skipped: Sequence[SkippedFrame],
    taken: int,
    frames_per_second: float,
    interrupted: int | None,
    topological_map: TopologicalMap,
    visits: Sequence[Visit],
) -> dict[str, object]:
    """What run.json holds: all that tells how the map came to be."""
    return {
        "source": settings.uri,
        "T_map_source": topological_map.T_map_source.tolist(),
        "parameters": {
            "detectors": list(settings.detectors),
            "predictors": list(settings.predictors),
            "mapper": settings.mapper,
            "rule": settings.rule,
            "start": settings.start,
            "stop": settings.stop,
            "stride": settings.stride,
            "options": settings.options,
            "resume": settings.resume,
            "update": settings.update,
            "hours_later": settings.hours_later,
        },
        "visits": [visit.as_json() for visit in visits],
        "versions": {
            "afkb": __version__,
            "python": platform.python_version(),
            **{name: _version_of(name) for name in RECORDED_PACKAGES},
        },
        "frames": {
            "used": taken,
            "skipped": len(skipped),
            "reasons": [
                {"index": s.index, "where": s.where, "why": s.why}
                for s in skipped[:MAX_LISTED_SKIPS]
            ],
        },
        "interrupted_by": signal.Signals(interrupted).name if interrupted else None,
        "counts": dict(topological_map.counts),
        "loops": [_loop(p) for p in topological_map.loops],
        "notes": list(topological_map.notes),
        "frames_per_second": round(frames_per_second, 2),
        "peak_memory_mb": round(_peak_memory_mb(), 1),
        "seconds": {k: round(v, 3) for k, v in stages.seconds.items()},
    }


def _loop(proposal: LoopProposal) -> dict[str, object]:
    """A place seen again, or not: what was proposed, whether it was accepted, and why."""
    told: dict[str, object] = {
        "by": proposal.kind.value,
        "view": proposal.view,
        "earlier_view": proposal.earlier_view,
        "place": proposal.place,
        "earlier_place": proposal.earlier_place,
        "weight": round(proposal.weight, 2),
        "accepted": proposal.accepted,
        "reason": proposal.reason,
    }
    if proposal.accepted:
        told["corrected_m"] = round(proposal.corrected_m, 4)
        told["corrected_rad"] = round(proposal.corrected_rad, 4)
    return told


def _version_of(package: str) -> str | None:
    try:
        return version(package)
    except ImportError:
        return None


def _peak_memory_mb() -> float:
    """Greatest resident memory of this process.

    Linux tells it per program in /proc; getrusage would add what the parent had at the fork.
    """
    status = Path("/proc/self/status")
    if status.is_file():
        for line in status.read_text().splitlines():
            if line.startswith("VmHWM:"):
                return int(line.split()[1]) / 1024
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak / 1024 if sys.platform != "darwin" else peak / 1024**2
