"""Writes files of the ontology: one writer at a time, and readers meet a whole file or the old."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from filelock import FileLock, Timeout

from afkb.errors import KnowledgeError

_PATIENCE_S = 120.0
"""How long a writer waits for another one, s; a build takes about ten."""


@contextmanager
def one_writer(path: Path, patience_s: float = _PATIENCE_S) -> Iterator[None]:
    """Hold a file's lock; `KnowledgeError` where another process keeps it for too long."""
    lock = FileLock(path.with_name(f".{path.name}.lock"), timeout=patience_s)
    try:
        with lock:
            yield
    except Timeout as error:
        raise KnowledgeError(
            f"{path}: another process has been writing it for {patience_s:.0f} s; "
            "wait for it, or stop it"
        ) from error


def put_whole(path: Path, text: str) -> None:
    """Replace a file by a new one in one step, so that nobody reads half of it.

    Raises `OSError` where the folder can't be written to; the old file then stays as it was.
    What is no file, as /dev/stdout, is written to as it stands.
    """
    if path.exists() and not path.is_file():
        path.write_text(text, encoding="utf-8")
        return
    mode = path.stat().st_mode & 0o777 if path.exists() else 0o644
    handle, scratch = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
    try:
        with os.fdopen(handle, "w", encoding="utf-8", newline="") as file:
            file.write(text)
        Path(scratch).chmod(mode)
        Path(scratch).replace(path)
    except BaseException:
        Path(scratch).unlink(missing_ok=True)
        raise
