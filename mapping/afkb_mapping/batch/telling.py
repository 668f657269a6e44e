"""Shows how far a batch is: a bar on a terminal, a line per recording in any case."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from afkb_mapping.batch.job import Outcome


@contextmanager
def shown(total: int) -> Iterator[Callable[[Outcome], None]]:
    """A function to call with each outcome."""
    if sys.stderr.isatty():
        with _bar(total) as tell:
            yield tell
    else:
        yield _lines(total)


@contextmanager
def _bar(total: int) -> Iterator[Callable[[Outcome], None]]:
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn
    from rich.progress import TimeElapsedColumn as Elapsed

    columns = (TextColumn("mapping"), BarColumn(), MofNCompleteColumn(), Elapsed())
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("mapping", total=total)

        def tell(outcome: Outcome) -> None:
            bar.console.print(_line(outcome), highlight=False, markup=False)
            bar.advance(task)

        yield tell


def _lines(total: int) -> Callable[[Outcome], None]:
    done = 0

    def tell(outcome: Outcome) -> None:
        nonlocal done
        done += 1
        print(f"{done}/{total} {_line(outcome)}", file=sys.stderr, flush=True)

    return tell


def _line(outcome: Outcome) -> str:
    error = f": {outcome.error}" if outcome.error else ""
    return f"{outcome.name}: {outcome.state.value}{error}, {outcome.seconds:.0f} s"
