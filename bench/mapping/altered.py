"""Recordings that something has happened to, made from whole ones as they are read."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from itertools import islice

from afkb.flow import SkippedFrame, View
from afkb.plugins.host import PluginHost
from afkb.plugins.protocols import Source

Frames = Iterable[View | SkippedFrame]
Alter = Callable[[Frames], Frames]


@dataclass
class AlteredSource:
    """A source with its frames altered; the same ones each time, numbered anew."""

    source: Source
    alter: Alter
    _count: int | None = field(default=None, init=False)

    @property
    def uri(self) -> str:
        """What it was opened from."""
        return self.source.uri

    @property
    def gravity_aligned(self) -> bool:
        """Whether z of its pose frame points up."""
        return self.source.gravity_aligned

    def __len__(self) -> int:
        if self._count is None:
            self._count = sum(1 for _ in self.alter(self.source.views()))
        return self._count

    def views(
        self, start: int = 0, stop: int | None = None, stride: int = 1
    ) -> Iterator[View | SkippedFrame]:
        """Its frames `start, start + stride, … < stop`."""
        altered = (replace(f, index=i) for i, f in enumerate(self.alter(self.source.views())))
        return islice(altered, start, stop, stride)


class AlteringHost(PluginHost):
    """A host whose recordings are all altered."""

    def __init__(self, alter: Alter) -> None:
        super().__init__()
        self._alter = alter

    def open_source(self, uri: str, options: Mapping[str, str] | None = None) -> Source:
        """The recording at `uri`, altered."""
        return AlteredSource(super().open_source(uri, options), self._alter)


def without_laser(frames: Frames) -> Frames:
    """The recording with its laser switched off."""
    return (replace(f, scan=None) if isinstance(f, View) else f for f in frames)
