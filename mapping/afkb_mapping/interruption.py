"""Ctrl-C and SIGTERM end a run after the frame at hand, so that the map so far can be written."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable
from types import FrameType


class Interruption:
    """Turns the first SIGINT or SIGTERM into a wish to stop; a second one ends the program.

    Only the main thread gets signals: a run in another one is not interrupted by them.
    """

    def __init__(self) -> None:
        self.signal: int | None = None
        self._before: dict[int, Callable[[int, FrameType | None], object] | int | None] = {}

    def __enter__(self) -> Interruption:
        heard = threading.current_thread() is threading.main_thread()
        for number in (signal.SIGINT, signal.SIGTERM) if heard else ():
            self._before[number] = signal.signal(number, self._on_signal)
        return self

    def __exit__(self, *_: object) -> None:
        for number, handler in self._before.items():
            signal.signal(number, handler)

    def _on_signal(self, number: int, _frame: FrameType | None) -> None:
        self.signal = number
        signal.signal(number, signal.SIG_DFL)
