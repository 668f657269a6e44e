"""What becomes of an error: one clear line on stderr, and an exit code that says whose it was."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager

import typer

from afkb.errors import AfkbError, KnowledgeError

FAILURE = 1
INTERRUPTED = 130


@contextmanager
def told_in_one_line(debug: bool) -> Iterator[None]:
    """Turn whatever a command raises into `error: …` on stderr and exit 1; Ctrl-C into 130.

    With `debug` the traceback is shown instead. Wrong usage is typer's own affair (exit 2).
    """
    try:
        yield
    except (typer.Exit, typer.Abort):
        raise
    except AfkbError as error:
        _fail(str(error), debug, error)
    except KeyboardInterrupt:
        typer.echo("interrupted", err=True)
        raise typer.Exit(INTERRUPTED) from None
    except BrokenPipeError:
        # Whoever read the output has enough (`afkb query … | head`); nothing is left to flush.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        raise typer.Exit(0) from None
    except (OSError, MemoryError) as error:
        _fail(str(error) or "out of memory", debug, error)
    except Exception as error:
        if hasattr(error, "exit_code"):
            raise  # Wrong usage, which typer explains.
        kind = type(error).__name__
        _fail(f"unexpected {kind}: {error} - run again with --debug and report it", debug, error)


def _fail(message: str, debug: bool, error: BaseException) -> None:
    if debug:
        raise error
    lines = message.splitlines() if isinstance(error, KnowledgeError) else [message]
    for line in lines:
        typer.echo(f"error: {' '.join(line.split())}", err=True)
    raise typer.Exit(FAILURE) from error
