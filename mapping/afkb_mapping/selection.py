"""Which frames of a recording a run looks at."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from afkb.errors import SourceError
from afkb.flow import SkippedFrame, View
from afkb.plugins.protocols import Source
from afkb_mapping.placing.levelling import SAMPLED_VIEWS, SAMPLED_VIEWS_UPRIGHT


@dataclass(frozen=True, slots=True)
class FrameRange:
    """Frames `start, start + stride, … < stop`; a stop of None is the recording's end."""

    start: int = 0
    stop: int | None = None
    stride: int = 1


class Selection:
    """The frames of a source that are in a range."""

    def __init__(self, source: Source, frames: FrameRange) -> None:
        self._source = source
        self._range = range(*slice(frames.start, frames.stop, frames.stride).indices(len(source)))

    def __len__(self) -> int:
        return len(self._range)

    @property
    def frames_there_are(self) -> int:
        """How many frames the source has, in the range or not."""
        return len(self._source)

    @property
    def gravity_aligned(self) -> bool:
        """Whether z of the source's pose frame points up."""
        return self._source.gravity_aligned

    def frames(self) -> Iterator[View | SkippedFrame]:
        """All of them, in order."""
        return self._source.views(self._range.start, self._range.stop, self._range.step)

    def sample(self) -> list[View]:
        """Usable views spread over the selection, the first usable one first.

        Raises `SourceError` where there is none.
        """
        skipped: list[SkippedFrame] = []
        for frame in self.frames():
            if isinstance(frame, View):
                return [frame, *self._spread_after(frame)]
            skipped.append(frame)
        raise SourceError(self.nothing_usable(skipped))

    def _spread_after(self, first: View) -> Iterator[View]:
        wanted = SAMPLED_VIEWS_UPRIGHT if self.gravity_aligned else SAMPLED_VIEWS
        stride = self._range.step * max(1, len(self._range) // wanted)
        for frame in self._source.views(first.index + stride, self._range.stop, stride):
            if isinstance(frame, View):
                yield frame

    def nothing_usable(self, skipped: Sequence[SkippedFrame]) -> str:
        """What to tell a user whose recording gave no view."""
        if not len(self):
            return (
                f"{self._source.uri}: no frames between --start and --stop, "
                f"it has {len(self._source)}"
            )
        if not skipped:
            return f"{self._source.uri}: stopped before the first frame was mapped"
        why = f"{skipped[0].where}: {skipped[0].why}"
        return f"{self._source.uri}: none of {len(skipped)} frames can be used; the first: {why}"
