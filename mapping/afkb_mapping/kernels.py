"""How loops over pixels are compiled, said in one place; importing this imports numba."""

from __future__ import annotations

import gc
from collections.abc import Callable
from typing import TypeVar

import numba
from numba.core import event

Loop = TypeVar("Loop", bound=Callable[..., object])


def kernel(loop: Loop) -> Loop:
    """The same function, compiled on its first call and kept on disk; it runs without the GIL.

    Floats divide as numpy's do: by zero they give inf or nan. It is compiled anew for each set of
    types: give it contiguous arrays, and from other kernels typed numbers rather than literals.
    """
    compiled: Loop = numba.njit(cache=True, nogil=True, error_model="numpy", no_cfunc_wrapper=True)(
        loop
    )
    return compiled


class _Uncollected(event.Listener):  # type: ignore[misc]  # numba is untyped
    """Keeps the garbage collector from looking through all that lives while a kernel is compiled.

    The compiler makes so many objects that it would do so all the time.
    """

    def __init__(self) -> None:
        self._depth, self._enabled = 0, False

    def on_start(self, event: event.Event) -> None:
        if self._depth == 0:
            self._enabled = gc.isenabled()
            gc.disable()
        self._depth += 1

    def on_end(self, event: event.Event) -> None:
        self._depth -= 1
        if self._depth == 0 and self._enabled:
            gc.enable()


event.register("numba:compile", _Uncollected())
