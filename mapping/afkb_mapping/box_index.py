"""Things by where they are, so that a view asks only what is near it and not the whole map."""

from __future__ import annotations

import math
from collections.abc import Hashable, Iterable, Iterator
from typing import Generic, TypeVar

import numpy as np
from numpy.typing import NDArray

CELL_M = 1.0
"""About the size of furniture: a thing is in a few cells, and a cell has a few things."""

Thing = TypeVar("Thing", bound=Hashable)
Span = tuple[int, int, int, int]


class BoxIndex(Generic[Thing]):
    """A hash of square cells over boxes that may move; answers come in order of first arrival.

    What a question costs depends on what is near, not on how much there is.
    """

    def __init__(self) -> None:
        self._cells: dict[tuple[int, int], dict[Thing, None]] = {}
        self._spans: dict[Thing, Span] = {}
        self._ranks: dict[Thing, int] = {}
        self._arrived = 0

    def __len__(self) -> int:
        return len(self._spans)

    def __iter__(self) -> Iterator[Thing]:
        return iter(list(self._spans))

    def __contains__(self, thing: Thing) -> bool:
        return thing in self._spans

    def put(self, thing: Thing, low_xy: NDArray[np.float64], high_xy: NDArray[np.float64]) -> None:
        """Put a thing where its box is, m; one that is there already moves and keeps its turn."""
        span = _span(low_xy, high_xy)
        before = self._spans.get(thing)
        if before == span:
            return
        if before is not None:
            self._leave(thing, before)
        else:
            self._ranks[thing] = self._arrived
            self._arrived += 1
        self._spans[thing] = span
        for cell in _cells(span):
            self._cells.setdefault(cell, {})[thing] = None

    def remove(self, thing: Thing) -> None:
        """Take a thing out; `KeyError` if it is not there."""
        self._leave(thing, self._spans.pop(thing))
        del self._ranks[thing]

    def near(self, low_xy: NDArray[np.float64], high_xy: NDArray[np.float64]) -> list[Thing]:
        """All things whose boxes touch this one, m, and some beside them, the first to come first.

        Which of them really touch is for the caller to say: it knows their shapes.
        """
        span = _span(low_xy, high_xy)
        found: set[Thing] = set()
        if (span[2] - span[0] + 1) * (span[3] - span[1] + 1) > len(self._cells):
            found.update(t for t, other in self._spans.items() if _touch(span, other))
        else:
            for cell in _cells(span):
                found.update(self._cells.get(cell, ()))
        return self.in_order(found)

    def in_order(self, things: Iterable[Thing]) -> list[Thing]:
        """Things that are in it, the first to come first."""
        return sorted(things, key=self._ranks.__getitem__)

    def _leave(self, thing: Thing, span: Span) -> None:
        for cell in _cells(span):
            here = self._cells[cell]
            del here[thing]
            if not here:
                del self._cells[cell]


def _span(low_xy: NDArray[np.float64], high_xy: NDArray[np.float64]) -> Span:
    """First and last column and row of the cells that a box touches."""
    return (
        math.floor(low_xy[0] / CELL_M),
        math.floor(low_xy[1] / CELL_M),
        math.floor(high_xy[0] / CELL_M),
        math.floor(high_xy[1] / CELL_M),
    )


def _cells(span: Span) -> Iterator[tuple[int, int]]:
    for col in range(span[0], span[2] + 1):
        for row in range(span[1], span[3] + 1):
            yield col, row


def _touch(a: Span, b: Span) -> bool:
    return a[0] <= b[2] and b[0] <= a[2] and a[1] <= b[3] and b[1] <= a[3]
