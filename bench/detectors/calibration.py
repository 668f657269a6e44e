"""Whether probabilities mean what they say, on recordings with labels."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from bench.calibration.diagram import diagram
from bench.calibration.gather import gathered
from bench.calibration.report import report
from bench.calibration.report import table as lines_of
from bench.detectors.data import Asked

NEEDS = ("homes",)
IN_PICTURE = ("all", "0 to 1.5 m", "1.5 to 3 m", "3 to inf m")


def run(asked: Asked) -> dict[str, Any]:
    """As shipped, as scored, and by curves of the other buildings."""
    result = report(gathered(asked))
    if asked.pictures:
        asked.pictures.mkdir(parents=True, exist_ok=True)
        (asked.pictures / "calibration.svg").write_text(diagram(result, IN_PICTURE))
    return result


def table(result: dict[str, Any]) -> Iterator[str]:
    yield from lines_of(result)
