"""What each detector takes of a frame of a home, on one core."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from bench.detectors.data import Asked, Home

NEEDS = ("homes",)


def run(asked: Asked) -> dict[str, Any]:
    """CPU milliseconds a frame by home and detector; `all` is their sum in each frame.

    The first frame is left out: it loads what is compiled.
    """
    return {h.name: _of(h) for h in asked.homes}


def _of(home: Home) -> dict[str, Any]:
    taken = {name: np.array(ms[1:]) for name, ms in home.seen.milliseconds.items()}
    taken["all"] = np.sum(list(taken.values()), axis=0)
    return {
        name: {"median": float(np.median(ms)), "p95": float(np.percentile(ms, 95))}
        for name, ms in taken.items()
        if len(ms)
    }


def table(result: dict[str, Any]) -> Iterator[str]:
    for home, detectors in result.items():
        yield f"{home}: ms a frame, median and 95 %"
        for name, ms in detectors.items():
            yield f"  {name:16} {ms['median']:6.1f} {ms['p95']:6.1f}"
