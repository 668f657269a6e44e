"""Puts what an exporter wrote where the user wants it: whole files, and none lost unasked."""

from __future__ import annotations

import os
import shutil
from collections.abc import Sequence
from pathlib import Path

from afkb.errors import MapError

_BUSY = ".partial"


def deliver(
    files: Sequence[Path], written_in: Path, out: Path | None, name: str, force: bool
) -> list[Path]:
    """Put files to their place and return where they are.

    - `written_in`: the folder that holds them, on any disk.
    - `out`: a single file's name, or the folder it goes into where that exists; several files'
      folder, made where it is missing. None: in the current folder, after `name`.
    - `force`: replace what is there.

    Each file is whole at its place or not there, whenever the process is killed. `MapError` where
    one exists that isn't to be replaced, before any was put.
    """
    if len(files) == 1:
        targets = {files[0]: _single(files[0], out, name)}
    else:
        folder = out or Path.cwd() / name
        if folder.exists() and not folder.is_dir():
            raise MapError(
                f"{folder}: is a file, and {len(files)} files are to be written; name a folder"
            )
        targets = {file: folder / file.relative_to(written_in) for file in files}
    there = next((t for t in targets.values() if os.path.lexists(t)), None)
    if there is not None and not force:
        raise MapError(f"{there}: is there already; name another --out, or replace it with --force")
    folders = (t for t in targets.values() if t.is_dir())
    if (taken := next(folders, None)) is not None:
        raise MapError(f"{taken}: is a folder, and a file of that name is to be written")
    for file, target in targets.items():
        target.parent.mkdir(parents=True, exist_ok=True)
        _put(file, target)
    return list(targets.values())


def _single(file: Path, out: Path | None, name: str) -> Path:
    named = name + "".join(file.suffixes)
    if out is None:
        return Path.cwd() / named
    return out / named if out.is_dir() else out


def _put(file: Path, target: Path) -> None:
    """Copy beside its place, force it to the disk, then take the place in one step."""
    busy = target.with_name(f".{target.name}.{os.getpid()}{_BUSY}")
    try:
        with file.open("rb") as source, busy.open("wb") as copy:
            shutil.copyfileobj(source, copy)
            copy.flush()
            os.fsync(copy.fileno())
        busy.replace(target)
    finally:
        busy.unlink(missing_ok=True)
