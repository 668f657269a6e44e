"""The run: source → views → detections → hypotheses → map → folder."""

from __future__ import annotations

import io
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from afkb.errors import BadFrame, SourceError
from afkb.flow import SkippedFrame, TopologicalMap, View
from afkb.plugins.host import PluginHost
from afkb.plugins.protocols import RoomClassifier
from afkb.store import check_out, write_map
from afkb.store.made_with import ontology_record
from afkb_mapping.crew import Crew
from afkb_mapping.interruption import Interruption
from afkb_mapping.localisation.bands import STATE_FILE
from afkb_mapping.loops.closing import close_loops
from afkb_mapping.loops.naming import with_loops
from afkb_mapping.memory.storing import MEMORY_FILE, to_bytes
from afkb_mapping.memory.visit import Visit
from afkb_mapping.placing.placed_views import skipped
from afkb_mapping.recordings.depth_units import DepthsSeen
from afkb_mapping.recordings.notes import notes_of
from afkb_mapping.rooms.opinions import with_opinions
from afkb_mapping.run_record import Settings, Stages, run_record
from afkb_mapping.selection import Selection
from afkb_mapping.viewing import Audience
from afkb_mapping.visits.beginning import Beginning, beginning_of, check_continuing

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
            check_continuing(host, settings)
        with stages.timed("begin"):
            beginning = beginning_of(settings, selection)
            audience = Audience.of(host, settings.view, settings.uri)
        crew = Crew.of(host, settings, stages, beginning.memory, beginning.recollection, audience)
        way = _Way(crew, beginning.visit)
        for done in way.along(beginning.placed_views(selection, stages)):
            progress(Progress(done, len(selection), way.frames_per_second))
            if interruption.signal is not None:
                break
        beginning.check_end(settings, interruption.signal)
        if not way.used:
            raise SourceError(selection.nothing_usable(way.skipped))
        with stages.timed("finish"):
            found = _finished(crew, beginning, way, host.room_classifiers(), notes_of(source))
        run = run_record(
            settings,
            stages,
            way.skipped,
            way.used,
            way.frames_per_second,
            interruption.signal,
            found,
            beginning.memory.visits,
        )
        run["ontology"] = ontology_record(host.knowledge_base.files)
        write_map(
            settings.out,
            found,
            run,
            exporters=[e for e in host.exporters() if e.in_map_folder],
            knowledge_base=host.knowledge_base,
            update=settings.update,
            state=_state(found, crew),
        )
        audience.end(found)
    return RunResult(found, run, interruption.signal)


@dataclass(slots=True, eq=False)
class _Way:
    """The way through a recording: frame by frame, counting what was used and what was not."""

    crew: Crew
    visit: Visit
    used: int = 0
    with_depth: int = 0
    depths: DepthsSeen = field(default_factory=DepthsSeen)
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
            self.crew.take_in(self.visit.numbered(view))
        except BadFrame as error:
            self.skipped.append(skipped(view, error))
            return
        self.used += 1
        self.with_depth += view.depth_m is not None
        self.depths.add(view)


def _finished(
    crew: Crew,
    beginning: Beginning,
    way: _Way,
    classifiers: Sequence[RoomClassifier],
    told: Sequence[str],
) -> TopologicalMap:
    visit, placing = beginning.visit, beginning.placing
    found = _closed(crew, visit, crew.finish(visit.T_map_source))
    with crew.stages.timed("classify rooms"):
        found = with_opinions(found, classifiers)
    nothing = NO_DEPTH if not way.with_depth else None if found.entities else NOTHING_SEEN
    units = way.depths.note
    notes = (n for n in (*told, units, *visit.notes, *placing.notes, nothing) if n)
    counts = {**found.counts, **placing.counts}
    return replace(found, notes=(*found.notes, *notes), counts=counts)


def _closed(crew: Crew, visit: Visit, found: TopologicalMap) -> TopologicalMap:
    """The map with its loops closed: built anew, where these correct the robot's way."""
    if not crew.works_from_memory:
        return found
    with crew.stages.timed("close loops"):
        closed = close_loops(crew.memory.views, crew.network, found.closures)
    if closed.moved:
        crew.settle(closed.poses)
        found = crew.finish(visit.T_map_source)
    return with_loops(found, closed)


def _state(found: TopologicalMap, crew: Crew) -> dict[str, bytes]:
    """What continuing and locating need beyond the RDF.

    The trajectory, as text that `numpy.loadtxt` reads; what stands where, by height; and what is
    remembered of the views, where the mapper works from that.
    """
    text = io.StringIO()
    np.savetxt(text, found.trajectory, fmt="%.17g", header="stamp (s), T_map_base row by row (4x4)")
    state = {"trajectory.txt": text.getvalue().encode(), STATE_FILE: crew.bands().to_bytes()}
    if crew.works_from_memory:
        state[MEMORY_FILE] = to_bytes(crew.memory)
    return state
