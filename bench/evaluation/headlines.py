"""The figures at the top of the page, each read from the lines that its measurement printed."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from bench.evaluation.results import Result


@dataclass(frozen=True, slots=True)
class Headline:
    """What is told, the figure here, the figure beside it, and which measurement has both."""

    what: str
    here: str
    beside: str
    measurement: str


@dataclass(frozen=True, slots=True)
class _Sought:
    """Where a headline stands: patterns whose groups fill `here` and `beside`."""

    what: str
    measurement: str
    here: str
    beside: str = ""
    told: str = "{}"
    beside_told: str = "{}"


SOUGHT: tuple[_Sought, ...] = ()


def headlines(folder: Path) -> Iterator[Headline]:
    """Those whose measurement was made; `ValueError` where its lines have changed their form."""
    for sought in SOUGHT:
        found = Result.load(sought.measurement, folder)
        if found is not None:
            text = "\n".join(found.runs[0])
            here = sought.told.format(*_groups(sought.here, text, sought))
            beside = sought.beside_told.format(*_groups(sought.beside, text, sought))
            yield Headline(sought.what, here, beside if sought.beside else "", sought.measurement)


def _groups(pattern: str, text: str, sought: _Sought) -> tuple[str, ...]:
    if not pattern:
        return ("",)
    match = re.search(pattern, text, re.MULTILINE)
    if match is None:
        raise ValueError(f"{sought.measurement}: no line like {pattern!r}; mend headlines.py")
    return match.groups()
