"""How loops over pixels are compiled, said in one place; importing this imports numba."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

import numba

Loop = TypeVar("Loop", bound=Callable[..., object])


def kernel(loop: Loop) -> Loop:
    """The same function, compiled on its first call and kept on disk; it runs without the GIL.

    Floats divide as numpy's do: by zero they give inf or nan.
    """
    compiled: Loop = numba.njit(cache=True, nogil=True, error_model="numpy")(loop)
    return compiled
