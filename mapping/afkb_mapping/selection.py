"""Which frames of a recording a run looks at."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from afkb.errors import SourceError
from afkb.flow import SkippedFrame, View
from afkb.plugins.protocols import Source
from afkb_mapping.levelling import SAMPLED_VIEWS, SAMPLED_VIEWS_UPRIGHT
from afkb_mapping.run_record import Settings


class Selection:
    """Frames `start, start + stride, … < stop` of a source."""

    def __init__(self, source: Source, settings: Settings) -> None:
        self._source = source
        self._range = range(
            *slice(settings.start, settings.stop, settings.stride).indices(len(source))
        )

    def __len__(self) -> int:
        return len(self._range)

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
