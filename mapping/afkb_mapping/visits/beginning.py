"""How a run begins: anew, where an interrupted one stopped, or as a later visit to a map."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from afkb.errors import MapError, PluginError, SourceError
from afkb.flow import SkippedFrame, View
from afkb.plugins.host import PluginHost
from afkb_mapping.crew import works_from_memory
from afkb_mapping.memory.memory import Memory
from afkb_mapping.memory.recollection import Recollection
from afkb_mapping.memory.storing import memory_of
from afkb_mapping.memory.visit import Visit
from afkb_mapping.placing.levelling import level
from afkb_mapping.placing.placed_views import placed_views
from afkb_mapping.placing.record import PlacingRecord
from afkb_mapping.run_record import Settings, Stages
from afkb_mapping.selection import Selection
from afkb_mapping.visits.arrival import T_map_source_of_visit
from afkb_mapping.visits.clock import clock_offset

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Beginning:
    """What is remembered as a run begins; the visit that it makes is the memory's last.

    `recollection`: what an interrupted run had perceived of the same recording. `placing`: where
    the robot was lost on the way.
    """

    memory: Memory
    recollection: Recollection
    placing: PlacingRecord = field(default_factory=PlacingRecord)

    @property
    def visit(self) -> Visit:
        """The visit that the run makes."""
        return self.memory.visits[-1]

    def placed_views(self, selection: Selection, stages: Stages) -> Iterator[View | SkippedFrame]:
        """The recording's frames at their places in the map, or why they have none."""
        known = (remembered.view for remembered in self.memory.views)
        return placed_views(selection, self.visit.T_map_source, stages, known, self.placing)

    def check_end(self, settings: Settings, signal: int | None) -> None:
        """Raise `SourceError` where a resumed run ends before the interrupted one did."""
        if self.recollection.is_used_up:
            return
        why = "stopped" if signal else f"{settings.uri} ends"
        raise SourceError(f"{why} before the frame that {settings.out} ends with; it is as it was")


def check_continuing(host: PluginHost, settings: Settings) -> None:
    """Raise `PluginError` where a map is to be continued by a mapper that can't."""
    if not (settings.resume or settings.update):
        return
    if not works_from_memory(host.mapper_factory(settings.mapper)(settings.rule)):
        raise PluginError(
            f"mapper {settings.mapper!r} does not work from memory: its maps can't be "
            "continued; map each recording with --out, or use another --mapper"
        )


def beginning_of(settings: Settings, selection: Selection) -> Beginning:
    """How the run that was asked for begins.

    Raises `MapError` where the map to go on from has no memory or was asked for otherwise,
    `SourceError` where no frame can be used, or a later visit can't be located in the map.
    """
    if settings.resume and (settings.out.exists() or settings.update):
        return _resumed(settings, selection)
    if settings.update:
        return _updated(settings, selection)
    levelled = level(selection.sample(), selection.gravity_aligned)
    memory, notes = Memory(), (levelled.note,) if levelled.note else ()
    memory.begin(_visit(settings, selection, levelled.T_map_source, notes=notes))
    return Beginning(memory, Recollection())


def _resumed(settings: Settings, selection: Selection) -> Beginning:
    memory = memory_of(settings.out)
    visit, wanted = memory.visits[-1], _wanted(settings)
    for name, before in visit.parameters.items():
        if wanted.get(name) != before:
            raise MapError(
                f"{settings.out}: was begun with {name} {before}, not {wanted.get(name)}; "
                "resume it as it was begun, or map again with --out alone"
            )
    earlier = memory.before_last_visit()
    earlier.begin(visit)
    return Beginning(earlier, memory.of_last_visit())


def _updated(settings: Settings, selection: Selection) -> Beginning:
    memory = memory_of(settings.out).continued()
    before, sample = memory.visits[-1], selection.sample()
    levelled = level(sample, selection.gravity_aligned)
    T_map_source = T_map_source_of_visit(settings.out, selection, levelled.T_map_source)
    last_stamp = max(passed.stamp for passed in memory.passed)
    offset, note = clock_offset(last_stamp, sample[0].stamp, settings.hours_later)
    memory.begin(
        _visit(
            settings,
            selection,
            T_map_source,
            first_index=before.first_index + before.frames,
            clock_offset_s=offset,
            notes=tuple(n for n in (levelled.note, note) if n),
        )
    )
    return Beginning(memory, Recollection())


def _visit(settings: Settings, selection: Selection, T_map_source: Array, **more: Any) -> Visit:
    return Visit(settings.uri, _wanted(settings), T_map_source, selection.frames_there_are, **more)


def _wanted(settings: Settings) -> dict[str, Any]:
    """What has to be the same for a run to be gone on with; where it stops may differ."""
    return {
        "detectors": list(settings.detectors),
        "predictors": list(settings.predictors),
        "mapper": settings.mapper,
        "rule": settings.rule,
        "start": settings.start,
        "stride": settings.stride,
        "options": dict(settings.options),
    }
