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


_MS = r"([\d.]+) \([\d.]+\)"
_DUAL = r"^duals met: [^\[\n]*\["
_ENGINES = "rdflib {}, owlready2 {}, Oxigraph's server {} ms"

SOUGHT = (
    _Sought(
        "the paper's simulated home: rooms right (paper 4/4), by doors and walls",
        "reproduce-worlds",
        r"^ room categories right +4/4 +(\d/\d)",
        r"^ the same by doors and walls \[11\] +\S+ +(\d/\d)",
    ),
    _Sought(
        "its loop error, greatest, m (paper about 0)",
        "paper-home",
        r"^loop error of the robot, m \(paper: ~0\): ([\d.]+)",
    ),
    _Sought(
        "rooms of 58 real buildings told right, by what things afford",
        "inference-rooms",
        r"^ *affordances +accuracy ([\d.]+ ± [\d.]+)",
        r"^ *bayes +accuracy ([\d.]+ ± [\d.]+)[^\n]*\n *forest +accuracy ([\d.]+ ± [\d.]+)",
        beside_told="on the things' names: naive Bayes {}, random forest {}",
    ),
    _Sought(
        "purpose of a room, ms",
        "inference-speed",
        r"^purpose of a room +median ([\d.]+)",
        r"^purpose of a room, pgmpy +median ([\d.]+)[^\n]*\n"
        r"purpose of a room, pyAgrum +median ([\d.]+)",
        beside_told="pgmpy {}, pyAgrum {} ms",
    ),
    _Sought(
        "a typical query of 20,000 triples (things per room), ms",
        "sparql-peers",
        rf"^things per room\s+{_MS}",
        rf"^things per room\s+[\d.]+ \([\d.]+\)\s+{_MS}\s+{_MS}\s+{_MS}",
        beside_told=_ENGINES,
    ),
    _Sought(
        "a dual join of 20,000 triples, ms",
        "sparql-peers",
        rf"{_DUAL}\s+{_MS}",
        rf"{_DUAL}\s+[\d.]+ \([\d.]+\)\s+{_MS}\s+{_MS}\s+{_MS}",
        beside_told=_ENGINES,
    ),
    _Sought(
        "attacks on the server answered or refused as they should be",
        "serving-attacks",
        r"^(\d+ of \d+) answered or refused",
    ),
)


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
