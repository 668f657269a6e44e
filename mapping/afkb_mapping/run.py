"""The run: source → views → detections → hypotheses → map → folder."""

from __future__ import annotations

import io
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from afkb.errors import BadFrame, PluginError, SourceError
from afkb.flow import Detection, Hypothesis, SkippedFrame, TopologicalMap, View
from afkb.plugins.host import PluginHost
from afkb.plugins.protocols import Mapper, Predictor
from afkb.store import check_out, write_map
from afkb_mapping.interruption import Interruption
from afkb_mapping.levelling import Level, level
from afkb_mapping.localisation.bands import STATE_FILE, BandBuilder
from afkb_mapping.perception import Perception, blamed
from afkb_mapping.placed_views import placed_views, skipped
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
            source = host.open_source(settings.uri, settings.options)
            selection = Selection(source, settings.frames)
            crew = _Crew.of(host, settings, stages)
        with stages.timed("level"):
            levelled = level(selection.sample(), selection.gravity_aligned)
        way = _Way(crew)
        for done in way.along(placed_views(selection, levelled.T_map_source, stages)):
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
            state=_state(found, crew.bands),
        )
    return RunResult(found, run, interruption.signal)


@dataclass(frozen=True, slots=True, eq=False)
class _Crew:
    """The plugins that a run uses."""

    perception: Perception
    predictors: Sequence[Predictor]
    mapper: Mapper
    stages: Stages
    bands: BandBuilder = field(default_factory=BandBuilder)

    @classmethod
    def of(cls, host: PluginHost, settings: Settings, stages: Stages) -> _Crew:
        return cls(
            Perception(host.detectors(settings.detectors), stages),
            host.predictors(settings.predictors),
            host.mapper_factory(settings.mapper)(settings.rule),
            stages,
        )

    def take_in(self, view: View) -> None:
        """One placed view, from what is detected in it to the map.

        Raises `BadFrame` where a detector or predictor fails on it, before the map has changed.
        """
        try:
            detections = self.perception.detections(view)
            hypotheses = self._predict(detections)
        except PluginError as error:
            raise BadFrame(str(error)) from error
        with self.stages.timed("map"), blamed("mapper", type(self.mapper).__name__):
            self.mapper.add(view, detections, hypotheses)
        with self.stages.timed("bands"):
            self.bands.add(view)

    def _predict(self, detections: Sequence[Detection]) -> list[Hypothesis]:
        hypotheses: list[Hypothesis] = []
        for predictor in self.predictors:
            name = predictor.name
            with self.stages.timed(f"predict {name}"), blamed("predictor", name):
                hypotheses += predictor.predict(detections)
        return hypotheses


@dataclass(slots=True, eq=False)
class _Way:
    """The way through a recording: frame by frame, counting what was used and what was not."""

    crew: _Crew
    used: int = 0
    with_depth: int = 0
    skipped: list[SkippedFrame] = field(default_factory=list)
    begun: float = field(default_factory=time.perf_counter)

    @property
    def frames_per_second(self) -> float:
        """Frames used per second of the way so far."""
        return self.used / max(time.perf_counter() - self.begun, 1e-9)

    def along(self, frames: Iterable[View | SkippedFrame]) -> Iterator[int]:
        """Take in frame after frame; yields how many are done."""
        for done, frame in enumerate(frames, start=1):
            if isinstance(frame, SkippedFrame):
                self.skipped.append(frame)
            else:
                self._take_in(frame)
            yield done

    def _take_in(self, view: View) -> None:
        try:
            self.crew.take_in(view)
        except BadFrame as error:
            self.skipped.append(skipped(view, error))
            return
        self.used += 1
        self.with_depth += view.depth_m is not None


def _finished(mapper: Mapper, levelled: Level, way: _Way) -> TopologicalMap:
    found = mapper.finish(levelled.T_map_source)
    nothing = NO_DEPTH if not way.with_depth else None if found.entities else NOTHING_SEEN
    notes = (n for n in (levelled.note, nothing) if n)
    return replace(found, notes=(*found.notes, *notes))


def _state(found: TopologicalMap, bands: BandBuilder) -> dict[str, bytes]:
    """What continuing and locating need beyond the RDF.

    The trajectory, as text that `numpy.loadtxt` reads; what stands where, by height.
    """
    text = io.StringIO()
    np.savetxt(text, found.trajectory, fmt="%.17g", header="stamp (s), T_map_base row by row (4x4)")
    return {"trajectory.txt": text.getvalue().encode(), STATE_FILE: bands.bands().to_bytes()}
