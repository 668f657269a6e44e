"""Who works in a run: detectors, predictors and the mapper, and what is remembered of each view."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from afkb.errors import BadFrame, PluginError
from afkb.flow import Detection, Hypothesis, TopologicalMap, View
from afkb.inference import Network, network_of
from afkb.plugins.host import PluginHost
from afkb.plugins.protocols import Mapper, Predictor
from afkb_mapping.localisation.bands import BandBuilder, HeightBands
from afkb_mapping.memory.memory import Memory
from afkb_mapping.memory.recollection import Recollection
from afkb_mapping.memory.remembered import RememberedView
from afkb_mapping.perception import Perception, blamed
from afkb_mapping.run_record import Settings, Stages
from afkb_mapping.viewing import Audience


class Crew:
    """The plugins of a run. What they make of a view is remembered, and mapped from memory.

    A mapper that says `works_from_memory` is given each view as it is remembered, so that it makes
    the same map of it when it is given it again. Any other gets all of the view, once.

    `recollection`: views that an interrupted run has perceived already. `audience`: who is shown
    each view once it is in the map.
    """

    def __init__(
        self,
        perception: Perception,
        predictors: Sequence[Predictor],
        new_mapper: Callable[[], Mapper],
        stages: Stages,
        memory: Memory,
        recollection: Recollection,
        network: Network,
        audience: Audience | None = None,
    ) -> None:
        self.memory, self.stages, self.network = memory, stages, network
        self._perception, self._predictors = perception, predictors
        self._new_mapper, self._recollection = new_mapper, recollection
        self._mapper, self._bands = new_mapper(), BandBuilder()
        self._audience = audience or Audience()
        self._replay(memory.views)

    @classmethod
    def of(
        cls,
        host: PluginHost,
        settings: Settings,
        stages: Stages,
        memory: Memory,
        recollection: Recollection,
        audience: Audience,
    ) -> Crew:
        """The plugins that were asked for. Raises `PluginError` for unknown ones."""
        factory = host.mapper_factory(settings.mapper)
        return cls(
            Perception(host.detectors(settings.detectors), stages),
            host.predictors(settings.predictors),
            lambda: factory(settings.rule),
            stages,
            memory,
            recollection,
            network_of(host.knowledge_base),
            audience,
        )

    @property
    def works_from_memory(self) -> bool:
        """Whether the map can be built again from what is remembered."""
        return works_from_memory(self._mapper)

    def take_in(self, view: View) -> None:
        """One placed view, from what is detected in it to the map.

        Raises `BadFrame` where a detector or predictor fails on it, before the map has changed.
        """
        if not self.works_from_memory:
            perceived = self._perceived(view)
            self._map(perceived)
            detections = perceived.detections
        elif self.memory.is_worth_keeping(view):
            remembered = self._recollection.of(view) or self._perceived(view).thinned()
            self._map(remembered)
            with self.stages.timed("remember"):
                self.memory.keep(remembered)
            detections = remembered.detections
        else:
            self.memory.pass_by(view)
            return
        with self.stages.timed("show"):
            self._audience.show(view, detections)

    def finish(self, T_map_source: NDArray[np.float64]) -> TopologicalMap:
        """The map of all that was taken in."""
        found = self._mapper.finish(T_map_source)
        if not self.works_from_memory:
            return found
        return replace(found, trajectory=self.memory.trajectory)

    def bands(self) -> HeightBands:
        """What stands where, by height."""
        return self._bands.bands()

    def settle(self, poses: Sequence[NDArray[np.float64]]) -> None:
        """Build the map anew, with the remembered views at other poses T_map_base (4, 4)."""
        self.memory.settle(poses)
        self._mapper, self._bands = self._new_mapper(), BandBuilder()
        self._replay(self.memory.settled_views)

    def _replay(self, views: Iterable[RememberedView]) -> None:
        with self.stages.timed("replay"):
            for remembered in views:
                self._map(remembered)

    def _map(self, seen: RememberedView) -> None:
        with self.stages.timed("map"), blamed("mapper", type(self._mapper).__name__):
            self._mapper.add(seen.view, seen.detections, seen.hypotheses)
        with self.stages.timed("bands"):
            self._bands.add(seen.view)

    def _perceived(self, view: View) -> RememberedView:
        try:
            detections = self._perception.detections(view)
            return RememberedView(view, tuple(detections), tuple(self._predict(detections)))
        except PluginError as error:
            raise BadFrame(str(error)) from error

    def _predict(self, detections: Sequence[Detection]) -> list[Hypothesis]:
        hypotheses: list[Hypothesis] = []
        for predictor in self._predictors:
            name = predictor.name
            with self.stages.timed(f"predict {name}"), blamed("predictor", name):
                hypotheses += predictor.predict(detections)
        return hypotheses


def works_from_memory(mapper: Mapper) -> bool:
    """Whether a mapper says that the remembered form of a view is enough for it."""
    return bool(getattr(mapper, "works_from_memory", False))
