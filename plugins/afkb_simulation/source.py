"""The simulated recording as a `Source`: lazy, re-readable, and silent about the truth."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from afkb.errors import BadFrame, SourceError
from afkb.flow import SkippedFrame, View
from afkb_simulation.reading import read_world, world_path
from afkb_simulation.simulation import Simulation


class WorldSource:
    """What the robot of a world senses on its tour, frame by frame."""

    gravity_aligned = True

    def __init__(self, uri: str, simulation: Simulation) -> None:
        self.uri = uri
        self._sense = simulation.view
        self._length = len(simulation.stops)

    def __len__(self) -> int:
        return self._length

    def views(
        self, start: int = 0, stop: int | None = None, stride: int = 1
    ) -> Iterator[View | SkippedFrame]:
        """Frames `start, start + stride, …`; each is the same whichever others are read."""
        for index in range(self._length)[start:stop:stride]:
            try:
                yield self._sense(index)
            except BadFrame as error:
                yield SkippedFrame(index, f"{self.uri} frame {index}", str(error))


def open_world(uri: str, options: Mapping[str, str] | None = None) -> WorldSource:
    """Open a path or `world:NAME`; option `seed` (a whole number) replaces the world's seed."""
    options = dict(options or {})
    world = read_world(uri)
    seed = options.pop("seed", None)
    if options:
        unknown = sorted(options)[0]
        raise SourceError(f"{uri}: no option {unknown!r}; a simulated world takes: seed")
    if seed is not None:
        if not seed.isdecimal():
            raise SourceError(f"{uri}: option seed={seed}: give a whole number from 0 up")
        world = world.model_copy(update={"seed": int(seed)})
    return WorldSource(uri, Simulation(world, world_path(uri)))
