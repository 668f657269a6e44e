"""What several readers work out of one view, worked out once."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import TypeVar
from weakref import WeakKeyDictionary

from afkb.flow import View

T = TypeVar("T")


def once_per_view(work: Callable[[View], T]) -> Callable[[View], T]:
    """The same function, that remembers its result for as long as the view lives.

    A view never changes, and a view placed anew is another one. Whoever asks shares the result
    with others, and must not write into it.
    """
    known: WeakKeyDictionary[View, T] = WeakKeyDictionary()

    @wraps(work)
    def remembered(view: View) -> T:
        if view not in known:
            known[view] = work(view)
        return known[view]

    return remembered
