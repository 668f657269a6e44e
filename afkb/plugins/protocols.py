"""What a plugin hands over: the shapes that sources, detectors, predictors … must have."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Protocol, runtime_checkable

if TYPE_CHECKING:  # Every command loads this; few of them need arrays.
    import numpy as np
    from numpy.typing import NDArray

    from afkb.flow import Detection, Hypothesis, SkippedFrame, TopologicalMap, View


@runtime_checkable
class Source(Protocol):
    """A recording: lazy, and readable any number of times with the same result.

    - `uri`: what it was opened from. `gravity_aligned`: whether z of its pose frame is up.
    - `len(source)`: number of frames, bad ones included.
    - `notes`: optional; lines on how the recording was read that its user should know, such as a
      camera that was guessed or lines that were left out. The map's `run.json` keeps them.
    """

    @property
    def uri(self) -> str:
        """What it was opened from."""
        ...

    @property
    def gravity_aligned(self) -> bool:
        """Whether z of its pose frame points up."""
        ...

    def __len__(self) -> int: ...

    def views(
        self, start: int = 0, stop: int | None = None, stride: int = 1
    ) -> Iterator[View | SkippedFrame]:
        """Frames `start, start + stride, … < stop`, each a `View` or why it is not one."""
        ...


@runtime_checkable
class Detector(Protocol):
    """Grounds affordance features in a view (paper §II.A, symbol grounding).

    - `name`: unique; what `--detector` takes. `affordances`: names of the features it can report.
    - `stage`: coarse before fine, as the filtrations go: 0 for what stands by itself (supports,
      bounds), 1 for what needs stage 0 (things on supports), 2 for what needs both (hollows of
      things), 3 for what any of these may afford besides.
    - `by_default`: optional; where it is False, the detector runs only if it is named, as a second
      implementation of another one does.
    """

    @property
    def name(self) -> str:
        """Unique name, as given on the command line."""
        ...

    @property
    def affordances(self) -> tuple[str, ...]:
        """Names of the features it can report."""
        ...

    @property
    def stage(self) -> int:
        """0 for what stands by itself, else it sees the detections of all lower stages."""
        ...

    def detect(self, view: View, earlier: Sequence[Detection]) -> Sequence[Detection]:
        """What it sees in a placed view; `earlier` holds this view's detections of lower stages."""
        ...


@runtime_checkable
class Predictor(Protocol):
    """Says what follows from what was seen, symbolically (paper §II.D.ii and iii)."""

    @property
    def name(self) -> str:
        """Unique name, as given on the command line."""
        ...

    @property
    def order(self) -> int:
        """1 for duals, 2 for co-occurrences."""
        ...

    def predict(self, detections: Sequence[Detection]) -> Sequence[Hypothesis]:
        """Hypotheses from one view's detections; anchors are indexes into them."""
        ...


@runtime_checkable
class Mapper(Protocol):
    """Turns the flow into a map, one viewpoint at a time (paper Algorithm 1).

    - `works_from_memory`: optional; where it is True, the mapper needs no more of a view than is
      remembered of it (every few pixels of depth, no colour; detections without their pixels and
      shapes). It is given that and nothing else, and its maps can be resumed and updated: a fresh
      mapper that is given the same again makes the same map.
    """

    def add(
        self, view: View, detections: Sequence[Detection], hypotheses: Sequence[Hypothesis]
    ) -> None:
        """Take in one placed view with what was detected in it and what follows."""
        ...

    def finish(self, T_map_source: NDArray[np.float64]) -> TopologicalMap:
        """The map of what was added so far; more may be added afterwards."""
        ...


@runtime_checkable
class MapperFactory(Protocol):
    """Makes a fresh mapper; `name` is what `--mapper` takes, `rule` what `--rule` takes."""

    @property
    def name(self) -> str:
        """Unique name, as given on the command line."""
        ...

    def __call__(self, rule: str) -> Mapper:
        """A fresh mapper that updates predictions by this rule."""
        ...


@runtime_checkable
class RoomClassifier(Protocol):
    """A second opinion on what the rooms of a finished map are for, to stand beside the mapper's.

    The mapper's own `Room.belief` stays what the map goes by.
    """

    @property
    def name(self) -> str:
        """Unique name, under which the map tells its beliefs."""
        ...

    def beliefs(self, topological_map: TopologicalMap) -> Mapping[str, Mapping[str, float]]:
        """Room id to P(room category), summing to 1, `UnknownRoom` among the keys.

        A room of which it can't tell anything is left out.
        """
        ...


@runtime_checkable
class Exporter(Protocol):
    """Writes a map in some format.

    - `in_map_folder`: part of every map folder (nav2 grid, report), not only of `afkb export`.
    - `same_bytes`: optional; False where the format holds what differs from run to run, random ids.

    The first line of its class's docstring is what `afkb export --list` says of it.
    """

    @property
    def name(self) -> str:
        """Unique name, as given on the command line."""
        ...

    @property
    def in_map_folder(self) -> bool:
        """Whether it is part of every map folder, not only of an export."""
        ...

    def export(
        self, topological_map: TopologicalMap, folder: Path, run: Mapping[str, object]
    ) -> Sequence[Path]:
        """Write into an existing folder; return the files written. `run` is run.json's content."""
        ...


@runtime_checkable
class AdjustableExporter(Exporter, Protocol):
    """An exporter that takes options: `afkb export --option key=value`."""

    @property
    def options(self) -> Mapping[str, str]:
        """What it takes: each option's name, and what it does in a few words."""
        ...

    def with_options(self, options: Mapping[str, str]) -> Exporter:
        """The same exporter set so; raises `PluginError` for an option or value it can't take."""
        ...


@runtime_checkable
class SceneExporter(Exporter, Protocol):
    """An exporter that rather works from a stored map's RDF than from the map itself."""

    def export_scene(
        self, turtle: bytes, folder: Path, run: Mapping[str, object]
    ) -> Sequence[Path]:
        """As `export`, given the content of scene.ttl; `afkb export` calls this instead."""
        ...


@runtime_checkable
class Viewer(Protocol):
    """Shows a map while it is made: `afkb map --view NAME`.

    What it does changes nothing in the map. One that fails is named and left out; the run goes on.
    """

    @property
    def name(self) -> str:
        """Unique name, as given on the command line."""
        ...

    def begin(self, uri: str, target: str | None) -> None:
        """Called once, before the first view, with the recording's URI.

        `target`: what the user wrote after the name, `--view NAME=TARGET`: a file, an address.
        Raises `PluginError` where it can't show anything, because a package is missing or the
        target is none: the run then doesn't begin.
        """
        ...

    def show(self, view: View, detections: Sequence[Detection]) -> None:
        """A placed view (`T_map_base` is set) and what was detected in it."""
        ...

    def end(self, topological_map: TopologicalMap) -> None:
        """The finished map, its loops closed: places may have moved since they were shown."""
        ...
