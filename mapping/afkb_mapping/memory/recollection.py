"""Views that an interrupted run has perceived already, handed out as they come by again."""

from __future__ import annotations

from collections.abc import Iterable

from afkb.errors import SourceError
from afkb.flow import View
from afkb_mapping.memory.remembered import RememberedView


class Recollection:
    """Remembered views of one visit, in the order of their index; at most one is held unpacked."""

    def __init__(self, views: Iterable[RememberedView] = ()) -> None:
        self._coming = iter(views)
        self._next = next(self._coming, None)

    @property
    def is_used_up(self) -> bool:
        """Whether every view of it has come by."""
        return self._next is None

    def of(self, view: View) -> RememberedView | None:
        """What is remembered of a placed view, at its pose; None where it was not remembered.

        Raises `SourceError` where another view was seen at this place in the recording.
        """
        if self._next is None or view.index < self._next.view.index:
            return None
        known, self._next = self._next, next(self._coming, None)
        if known.view.index != view.index or not known.is_of(view):
            raise SourceError(
                f"frame {view.index} is not what the interrupted run saw there: this is another "
                "recording, or it has changed; map it with --out alone"
            )
        assert view.T_map_base is not None
        return known.moved_to(view.T_map_base)
