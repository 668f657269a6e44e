"""The run: source → views → detections → hypotheses → map → folder, with counts and timings."""

from __future__ import annotations

import platform
import resource
import signal
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from importlib.metadata import version
from pathlib import Path
from types import FrameType

import numpy as np
from numpy.typing import NDArray

from afkb import __version__
from afkb.errors import PluginError, SourceError
from afkb.flow import Detection, Hypothesis, SkippedFrame, TopologicalMap, View
from afkb.plugins.host import PluginHost
from afkb.plugins.protocols import Detector, Mapper, Predictor, Source
from afkb.store import check_out, write_map
from afkb_mapping.levelling import SAMPLED_VIEWS, SAMPLED_VIEWS_UPRIGHT, level
from afkb_mapping.registration import ScanRegistration

RECORDED_PACKAGES = ("numpy", "numba", "open3d-cpu", "opencv-python-headless", "pgmpy", "rosbags")
MAX_LISTED_SKIPS = 20


@dataclass(frozen=True, slots=True)
class Settings:
    """What a run is asked to do; all of it is recorded in run.json."""

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


@dataclass(frozen=True, slots=True)
class Progress:
    """How far a run is: frames taken of frames there are, and frames per second so far."""

    done: int
    total: int
    frames_per_second: float


@dataclass(frozen=True, slots=True, eq=False)
class RunResult:
    """The map, what run.json holds, and whether a signal ended the run early."""

    topological_map: TopologicalMap
    run: dict[str, object]
    interrupted: int | None


class Interruption:
    """Turns the first SIGINT or SIGTERM into a wish to stop; a second one ends the program."""

    def __init__(self) -> None:
        self.signal: int | None = None
        self._before: dict[int, Callable[[int, FrameType | None], object] | int | None] = {}

    def __enter__(self) -> Interruption:
        for number in (signal.SIGINT, signal.SIGTERM):
            self._before[number] = signal.signal(number, self._on_signal)
        return self

    def __exit__(self, *_: object) -> None:
        for number, handler in self._before.items():
            signal.signal(number, handler)

    def _on_signal(self, number: int, _frame: FrameType | None) -> None:
        self.signal = number
        signal.signal(number, signal.SIG_DFL)


def make_map(
    host: PluginHost, settings: Settings, progress: Callable[[Progress], None] = lambda _: None
) -> RunResult:
    """Map a recording into a folder: the whole way of every datum, in one function.

    Raises `SourceError` where no frame of the recording can be used, `MapError` where the folder
    can't be written, `PluginError` for unknown plugins; then nothing has been written.
    """
    stages, skipped = Stages(), []
    check_out(settings.out)
    with stages.timed("start"):
        source = host.open_source(settings.uri, settings.options)
        detectors = host.detectors(settings.detectors)
        predictors = host.predictors(settings.predictors)
        mapper = host.mapper_factory(settings.mapper)(settings.rule)
    begun = time.perf_counter()
    with Interruption() as interruption:
        with stages.timed("level"):
            levelled = level(_sample(source, settings), source.gravity_aligned)
        registration = ScanRegistration(levelled.T_map_source)
        frames = source.views(settings.start, settings.stop, settings.stride)
        total, taken = _frame_count(source, settings), 0
        for done, frame in enumerate(_timed(frames, stages), start=1):
            if isinstance(frame, SkippedFrame):
                skipped.append(frame)
            else:
                view = _placed(frame, registration, stages)
                detections = _detect(detectors, view, stages)
                hypotheses = _predict(predictors, detections, stages)
                with stages.timed("map"):
                    mapper.add(view, detections, hypotheses)
                taken += 1
            progress(Progress(done, total, done / (time.perf_counter() - begun)))
            if interruption.signal is not None:
                break
        fps = taken / (time.perf_counter() - begun)
        if not taken:
            raise SourceError(_nothing_usable(settings.uri, skipped))
        with stages.timed("finish"):
            topological_map = _finished(mapper, levelled.T_map_source, levelled.note)
        run = _record(settings, stages, skipped, taken, fps, interruption.signal, topological_map)
        write_map(
            settings.out,
            topological_map,
            run,
            exporters=[e for e in host.exporters() if e.in_map_folder],
            knowledge_base=host.knowledge_base,
            state=_state(topological_map),
        )
    return RunResult(topological_map, run, interruption.signal)


def _frame_count(source: Source, settings: Settings) -> int:
    return len(range(*slice(settings.start, settings.stop, settings.stride).indices(len(source))))


def _sample(source: Source, settings: Settings) -> list[View]:
    """Views spread over the recording, the first usable one first."""
    wanted = SAMPLED_VIEWS if not source.gravity_aligned else SAMPLED_VIEWS_UPRIGHT
    stride = settings.stride * max(1, _frame_count(source, settings) // wanted)
    first = next(
        (
            f
            for f in source.views(settings.start, settings.stop, settings.stride)
            if isinstance(f, View)
        ),
        None,
    )
    if first is None:
        skipped = [
            f
            for f in source.views(settings.start, settings.stop, settings.stride)
            if isinstance(f, SkippedFrame)
        ]
        raise SourceError(_nothing_usable(settings.uri, skipped))
    rest = source.views(first.index, settings.stop, stride)
    return [first, *(f for f in rest if isinstance(f, View) and f.index != first.index)]


def _nothing_usable(uri: str, skipped: Sequence[SkippedFrame]) -> str:
    if not skipped:
        return f"{uri}: no frames between --start and --stop"
    why = f"{skipped[0].where}: {skipped[0].why}"
    return f"{uri}: none of {len(skipped)} frames can be used; the first one, {why}"


def _timed(frames: Iterator[View | SkippedFrame], stages: Stages) -> Iterator[View | SkippedFrame]:
    while True:
        with stages.timed("read"):
            frame = next(frames, None)
        if frame is None:
            return
        yield frame


def _placed(view: View, registration: ScanRegistration, stages: Stages) -> View:
    with stages.timed("register"):
        return replace(view, T_map_base=registration.place(view).T_map_base)


def _detect(detectors: Sequence[Detector], view: View, stages: Stages) -> list[Detection]:
    """All detections of a view, coarse before fine."""
    found: list[Detection] = []
    for stage in sorted({d.stage for d in detectors}):
        earlier = tuple(found)
        for detector in (d for d in detectors if d.stage == stage):
            with stages.timed(f"detect {detector.name}"), _blamed("detector", detector.name):
                found += detector.detect(view, earlier)
    return found


def _predict(
    predictors: Sequence[Predictor], detections: Sequence[Detection], stages: Stages
) -> list[Hypothesis]:
    hypotheses: list[Hypothesis] = []
    for predictor in predictors:
        with stages.timed(f"predict {predictor.name}"), _blamed("predictor", predictor.name):
            hypotheses += predictor.predict(detections)
    return hypotheses


@contextmanager
def _blamed(what: str, name: str) -> Iterator[None]:
    """Say whose fault it is when a plugin breaks its contract."""
    try:
        yield
    except (ValueError, TypeError, AttributeError) as error:
        raise PluginError(
            f"{what} {name!r} failed: {error}; run with --debug to see where, "
            "or leave it out by naming the others"
        ) from error


def _finished(
    mapper: Mapper, T_map_source: NDArray[np.float64], note: str | None
) -> TopologicalMap:
    topological_map = mapper.finish(T_map_source)
    return (
        replace(topological_map, notes=(*topological_map.notes, note))
        if note
        else (topological_map)
    )


def _record(
    settings: Settings,
    stages: Stages,
    skipped: Sequence[SkippedFrame],
    taken: int,
    frames_per_second: float,
    interrupted: int | None,
    topological_map: TopologicalMap,
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
        },
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
        "notes": list(topological_map.notes),
        "frames_per_second": round(frames_per_second, 2),
        "peak_memory_mb": round(_peak_memory_mb(), 1),
        "seconds": {k: round(v, 3) for k, v in stages.seconds.items()},
    }


def _version_of(package: str) -> str | None:
    try:
        return version(package)
    except ImportError:
        return None


def _peak_memory_mb() -> float:
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak / 1024 if sys.platform != "darwin" else peak / 1024**2


def _state(topological_map: TopologicalMap) -> dict[str, bytes]:
    """What continuing needs beyond the RDF: the trajectory, as text that `numpy.loadtxt` reads."""
    rows = "\n".join(" ".join(repr(float(v)) for v in row) for row in topological_map.trajectory)
    header = "# stamp (s), then T_map_base row by row (4x4, m)\n"
    return {"trajectory.txt": f"{header}{rows}\n".encode()}
