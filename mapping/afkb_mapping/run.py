"""The run: source → views → detections → hypotheses → map → folder."""

from __future__ import annotations

import io
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace

import numpy as np

from afkb.errors import BadFrame, PluginError, SourceError
from afkb.flow import Detection, Hypothesis, SkippedFrame, TopologicalMap, View
from afkb.plugins.host import PluginHost
from afkb.plugins.protocols import Detector, Mapper, Predictor
from afkb.store import check_out, write_map
from afkb_mapping.interruption import Interruption
from afkb_mapping.levelling import Level, level
from afkb_mapping.pose_gate import PoseGate
from afkb_mapping.registration import ScanRegistration
from afkb_mapping.run_record import Settings, Stages, run_record
from afkb_mapping.selection import Selection

NO_DEPTH = "no depth in this recording: the map has a grid and rooms by their shape, no affordances"

NOTHING_SEEN = (
    "nothing was detected in any depth image: check the depth scale, the intrinsics and the poses"
)


@dataclass(frozen=True, slots=True)
class Progress:
    """How far a run is: frames taken of frames there are, and frames per second so far."""

    done: int
    total: int
    frames_per_second: float


@dataclass(frozen=True, slots=True, eq=False)
class RunResult:
    """The map, what run.json holds, and the signal that ended the run early, if one did."""

    topological_map: TopologicalMap
    run: dict[str, object]
    interrupted: int | None


def make_map(
    host: PluginHost, settings: Settings, progress: Callable[[Progress], None] = lambda _: None
) -> RunResult:
    """Map a recording into a folder.

    Raises `SourceError` where no frame of the recording can be used, `MapError` where the folder
    can't be written, `PluginError` for unknown plugins; then nothing has been written. A signal
    ends it after the frame at hand; what was seen until then is written.
    """
    check_out(settings.out)
    stages = Stages()
    with Interruption() as interruption:
        with stages.timed("start"):
            selection = Selection(host.open_source(settings.uri, settings.options), settings)
            crew = _Crew.of(host, settings, stages)
        with stages.timed("level"):
            levelled = level(selection.sample(), selection.gravity_aligned)
        way = _Way(crew, ScanRegistration(levelled.T_map_source), stages)
        for done in way.along(selection):
            progress(Progress(done, len(selection), way.frames_per_second))
            if interruption.signal is not None:
                break
        if not way.used:
            raise SourceError(selection.nothing_usable(way.skipped))
        with stages.timed("finish"):
            found = _finished(crew.mapper, levelled, way)
        run = run_record(
            settings,
            stages,
            way.skipped,
            way.used,
            way.frames_per_second,
            interruption.signal,
            found,
        )
        write_map(
            settings.out,
            found,
            run,
            exporters=[e for e in host.exporters() if e.in_map_folder],
            knowledge_base=host.knowledge_base,
            state=_state(found),
        )
    return RunResult(found, run, interruption.signal)


@dataclass(frozen=True, slots=True, eq=False)
class _Crew:
    """The plugins that a run uses."""

    detectors: Sequence[Detector]
    predictors: Sequence[Predictor]
    mapper: Mapper
    stages: Stages

    @classmethod
    def of(cls, host: PluginHost, settings: Settings, stages: Stages) -> _Crew:
        return cls(
            host.detectors(settings.detectors),
            host.predictors(settings.predictors),
            host.mapper_factory(settings.mapper)(settings.rule),
            stages,
        )

    def take_in(self, view: View) -> None:
        """One placed view, from what is detected in it to the map.

        Raises `BadFrame` where a detector or predictor fails on it, before the map has changed.
        """
        try:
            detections = self._detect(view)
            hypotheses = self._predict(detections)
        except PluginError as error:
            raise BadFrame(str(error)) from error
        with self.stages.timed("map"), _blamed("mapper", type(self.mapper).__name__):
            self.mapper.add(view, detections, hypotheses)

    def _detect(self, view: View) -> list[Detection]:
        """All detections of a view, coarse before fine."""
        found: list[Detection] = []
        for stage in sorted({d.stage for d in self.detectors}):
            earlier = tuple(found)
            for detector in (d for d in self.detectors if d.stage == stage):
                name = detector.name
                with self.stages.timed(f"detect {name}"), _blamed("detector", name):
                    found += detector.detect(view, earlier)
        return found

    def _predict(self, detections: Sequence[Detection]) -> list[Hypothesis]:
        hypotheses: list[Hypothesis] = []
        for predictor in self.predictors:
            name = predictor.name
            with self.stages.timed(f"predict {name}"), _blamed("predictor", name):
                hypotheses += predictor.predict(detections)
        return hypotheses


@dataclass(slots=True, eq=False)
class _Way:
    """The way through a recording: frame by frame, counting what was used and what was not."""

    crew: _Crew
    registration: ScanRegistration
    stages: Stages
    gate: PoseGate = field(default_factory=PoseGate)
    used: int = 0
    with_depth: int = 0
    skipped: list[SkippedFrame] = field(default_factory=list)
    begun: float = field(default_factory=time.perf_counter)

    @property
    def frames_per_second(self) -> float:
        """Frames used per second of the way so far."""
        return self.used / max(time.perf_counter() - self.begun, 1e-9)

    def along(self, selection: Selection) -> Iterator[int]:
        """Take in frame after frame; yields how many are done."""
        for done, frame in enumerate(self._read(selection.frames()), start=1):
            if isinstance(frame, SkippedFrame):
                self.skipped.append(frame)
            else:
                self._take_in(frame)
            yield done

    def _read(self, frames: Iterator[View | SkippedFrame]) -> Iterator[View | SkippedFrame]:
        while True:
            with self.stages.timed("read"):
                frame = next(frames, None)
            if frame is None:
                return
            yield frame

    def _take_in(self, frame: View) -> None:
        try:
            self.gate.check(frame)
            with self.stages.timed("register"):
                view = replace(frame, T_map_base=self.registration.place(frame).T_map_base)
            self.crew.take_in(view)
        except BadFrame as error:
            self.skipped.append(SkippedFrame(frame.index, f"frame {frame.index}", str(error)))
            return
        self.used += 1
        self.with_depth += view.depth_m is not None


@contextmanager
def _blamed(what: str, name: str) -> Iterator[None]:
    """Say whose fault it is when a plugin fails, whatever it fails with."""
    try:
        yield
    except BadFrame:
        raise
    except Exception as error:
        raise PluginError(
            f"{what} {name!r} failed with {type(error).__name__}: {error}; "
            "mend it, or leave it out by naming the others"
        ) from error


def _finished(mapper: Mapper, levelled: Level, way: _Way) -> TopologicalMap:
    found = mapper.finish(levelled.T_map_source)
    nothing = NO_DEPTH if not way.with_depth else None if found.entities else NOTHING_SEEN
    notes = (n for n in (levelled.note, nothing) if n)
    return replace(found, notes=(*found.notes, *notes))


def _state(found: TopologicalMap) -> dict[str, bytes]:
    """What continuing needs beyond the RDF: the trajectory, as text that `numpy.loadtxt` reads."""
    text = io.StringIO()
    np.savetxt(text, found.trajectory, fmt="%.17g", header="stamp (s), T_map_base row by row (4x4)")
    return {"trajectory.txt": text.getvalue().encode()}
