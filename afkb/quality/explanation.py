"""Finds the few among many that are at fault together."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TypeVar

T = TypeVar("T")


def smallest(items: Sequence[T], is_bad: Callable[[Sequence[T]], bool]) -> list[T]:
    """A smallest part of the items that is bad: without any one of it, it is not.

    By halving (Junker, QuickXplain, 2004): a few among n take about 2 log n questions each.
    All items together must be bad, and what is bad must stay so with more.

    >>> smallest(range(100), lambda some: {7, 42} <= set(some))
    [7, 42]
    """
    return sorted_as(items, _find([], False, list(items), is_bad))


def sorted_as(items: Sequence[T], found: Sequence[T]) -> list[T]:
    """What was found, in the order of the items."""
    return [item for item in items if item in found]


def _find(
    base: list[T], grown: bool, rest: list[T], is_bad: Callable[[Sequence[T]], bool]
) -> list[T]:
    if grown and is_bad(base):
        return []
    if len(rest) == 1:
        return rest
    left, right = rest[: len(rest) // 2], rest[len(rest) // 2 :]
    of_right = _find([*base, *left], bool(left), right, is_bad)
    of_left = _find([*base, *of_right], bool(of_right), left, is_bad)
    return of_left + of_right
