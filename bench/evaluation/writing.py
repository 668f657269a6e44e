"""Writes `docs/evaluation.md` from the results that were kept."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from bench.evaluation.chapters import CHAPTERS, Chapter, Measurement
from bench.evaluation.headlines import headlines
from bench.evaluation.results import FOLDER, Result, spread

PAGE = Path(__file__).parents[2] / "docs" / "evaluation.md"
HEAD = """# All measurements

<!-- Written by `python -m bench.evaluation write` from bench/results; do not edit. -->

Each block is what its command printed, on the machine and at the revision that stand beside it. To
measure one again, `python -m bench.evaluation run NAME`; all that are missing,
`python -m bench.evaluation run`; then `python -m bench.evaluation write` makes this page. The
recordings are those of [how well it works](how-well-it-works.md); `AFKB_DATA` names their folder. A
machine's speed moves by a third from minute to minute: believe ratios within one run.
"""


def page(folder: Path = FOLDER) -> str:
    """The document; a measurement that was not made says so."""
    lines = [HEAD, *_summary(folder)]
    for chapter in CHAPTERS:
        lines += _chapter(chapter, folder)
    return "\n".join(lines).rstrip() + "\n"


def _summary(folder: Path) -> Iterator[str]:
    yield "## At a glance\n"
    yield "| | here | beside it | measured by |"
    yield "|---|---|---|---|"
    for told in headlines(folder):
        link = f"[{told.measurement}](#{told.measurement})"
        yield f"| {told.what} | {told.here} | {told.beside} | {link} |"
    yield ""


def _chapter(chapter: Chapter, folder: Path) -> Iterator[str]:
    yield f"## {chapter.title}\n"
    yield f"{chapter.about}\n"
    for measurement in chapter.measurements:
        yield from _measurement(measurement, Result.load(measurement.name, folder))


def _measurement(asked: Measurement, found: Result | None) -> Iterator[str]:
    yield f"### {asked.name}\n"
    if asked.about:
        yield f"{asked.about}\n"
    commands = "\n".join([*asked.before, asked.command])
    yield f"```sh\n{commands}\n```\n"
    if found is None:
        yield "Not measured yet.\n"
        return
    shown = "\n".join(found.runs[0])
    yield f"```text\n{shown}\n```\n"
    told = spread(found.runs)
    cost = f"{found.seconds:.0f} s, {found.memory_mb:.0f} MB at most"
    facts = f"{found.date}, revision {found.revision}; {cost}; {found.machine}."
    yield f"{told} {facts}\n".lstrip()
