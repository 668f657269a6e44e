"""What was read once, kept for the next start: keyed by content, so that it can't be stale."""

from __future__ import annotations

import copyreg
import gc
import hashlib
import os
import pickle
import sys
import tempfile
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from types import MappingProxyType
from typing import Any, TypeVar

from afkb.errors import KnowledgeError

T = TypeVar("T")
_KEPT_S = 30 * 24 * 3600.0
"""Entries that nobody used for so long are removed when a new one is written."""


def _frozen(mapping: dict[object, object]) -> MappingProxyType[object, object]:
    return MappingProxyType(mapping)


copyreg.pickle(MappingProxyType, lambda mapping: (_frozen, (dict(mapping),)))


def cache_folder() -> Path:
    """Where entries are kept: `AFKB_CACHE`, else the user's cache folder."""
    if os.environ.get("AFKB_CACHE"):
        return Path(os.environ["AFKB_CACHE"])
    from platformdirs import user_cache_path

    return user_cache_path("afkb", appauthor=False)


def content_key(files: Sequence[Path]) -> str:
    """A name for what the files say and how this version reads it; bytes alone count."""
    digest = hashlib.sha256(_reader_fingerprint())
    for file in files:
        digest.update(file.name.encode() + b"\0")
        for part in sorted(file.rglob("*.csv")) if file.is_dir() else [file]:
            digest.update(part.name.encode() + b"\0" + part.read_bytes() + b"\0")
    return digest.hexdigest()[:32]


def ontology_key(files: Sequence[Path]) -> str:
    """The key of an ontology and its extensions, with the tables of homes that these bring.

    `KnowledgeError` for a file that isn't there.
    """
    missing = [file for file in files if not file.exists()]
    if missing:
        raise KnowledgeError(f"{missing[0]}: no such ontology file; check the name")
    if len(files) == 1:
        return content_key(files)
    from afkb.extensions import files_behind

    return content_key(files_behind(files))


def cached(name: str, key: str, make: Callable[[], T]) -> T:
    """What `make` returns, from the cache where it is there; pickled, so of plain data alone.

    Safe where several processes start at once: an entry appears whole or not at all. Without a
    folder that can be written to, everything is made afresh.
    """
    path = cache_folder() / f"{name}-{key}.pickle"
    kept = _entry(path)
    if kept:
        found: T = kept[0]
        return found
    made = make()
    put(path, pickle.dumps(made, protocol=pickle.HIGHEST_PROTOCOL))
    return made


def _entry(path: Path) -> tuple[Any] | None:
    """What an entry holds, in a tuple of its own; None where there is none that can be read."""
    try:
        with _no_collection():
            return (pickle.loads(_own_bytes(path)),)
    except Exception:  # A damaged pickle may raise anything; it is made afresh.
        return None


@contextmanager
def _no_collection() -> Iterator[None]:
    """Spares the search for garbage while thousands of objects are made: it takes half the time."""
    was_on = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_on:
            gc.enable()


def cached_file(name: str, key: str, make: Callable[[], bytes]) -> Path | None:
    """Path of a file that holds what `make` returns; None where no folder can be written to."""
    path = cache_folder() / f"{key}-{name}"
    if not path.is_file():
        put(path, make())
    return path if path.is_file() else None


def put(path: Path, content: bytes) -> None:
    """Write an entry, whole or not at all; a folder that can't be written to is no error."""
    try:
        path.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
        handle, scratch = tempfile.mkstemp(dir=path.parent, prefix=".writing-")
        try:
            with os.fdopen(handle, "wb") as file:
                file.write(content)
            Path(scratch).replace(path)
        except BaseException:
            Path(scratch).unlink(missing_ok=True)
            raise
        _remove_old(path.parent.iterdir())
    except OSError:
        return


def _own_bytes(path: Path) -> bytes:
    """The entry's bytes, if it is this user's own: a stranger's pickle is not opened."""
    if hasattr(os, "getuid") and path.stat().st_uid != os.getuid():
        raise PermissionError(f"{path} belongs to another user")
    return path.read_bytes()


def _remove_old(entries: Iterable[Path]) -> None:
    for entry in entries:
        if time.time() - entry.stat().st_mtime > _KEPT_S:
            entry.unlink(missing_ok=True)


@cache
def _reader_fingerprint() -> bytes:
    """The code that reads, so that a changed reader never meets an old entry."""
    package = Path(__file__).parent.parent
    rooms = ("knowledge", "extensions", "ontology", "figures")
    sources = [*package.glob("*.py"), *(s for room in rooms for s in (package / room).glob("*.py"))]
    digest = hashlib.sha256(f"{sys.version_info[:2]}".encode())
    for source in sorted(sources):
        digest.update(source.read_bytes())
    return digest.digest()
