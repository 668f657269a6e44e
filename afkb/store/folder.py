"""Map folders on disk: whether one may be written, and how it is replaced in one step."""

from __future__ import annotations

import ctypes
import glob
import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from afkb.errors import MapError
from afkb.store.stored import RUN_FILE, SCENE_FILE

_AT_FDCWD = -100
_RENAME_EXCHANGE = 2
_SCRATCH = ".partial"


def check_out(folder: Path | str) -> Path:
    """The absolute folder to write to, after a look whether that can work.

    Called before hours of mapping. `MapError` where the folder can't be written, or holds
    something that is not a map: that is left alone.
    """
    folder = Path(os.path.abspath(Path(folder).expanduser()))  # noqa: PTH100 - keeps symlinks
    if folder.is_symlink():
        folder = folder.resolve()
    if folder.exists():
        _refuse_what_is_no_map(folder)
    try:
        folder.parent.mkdir(parents=True, exist_ok=True)
        with scratch_beside(folder):
            pass
    except OSError as error:
        raise MapError(
            f"{folder}: not writable ({error.strerror or error}); choose another --out"
        ) from error
    return folder


def _refuse_what_is_no_map(folder: Path) -> None:
    if not folder.is_dir():
        raise MapError(f"{folder}: is a file, not a map folder; left alone, choose another --out")
    if folder.is_mount():
        raise MapError(f"{folder}: is a mount point and can't be replaced; name a folder inside it")
    if Path.cwd().is_relative_to(folder.resolve()):
        raise MapError(f"{folder}: is the current folder; name a folder inside it")
    if not _is_map(folder) and any(folder.iterdir()):
        raise MapError(
            f"{folder}: holds something that is not a map; left alone, choose another --out"
        )


def _is_map(folder: Path) -> bool:
    return all((folder / name).is_file() for name in (SCENE_FILE, RUN_FILE))


@contextmanager
def scratch_beside(folder: Path) -> Iterator[Path]:
    """A fresh folder beside `folder`, on the same disk; gone afterwards if it is still there."""
    _remove_leftovers(folder)
    prefix = f".{folder.name}.{os.getpid()}."
    scratch = Path(tempfile.mkdtemp(prefix=prefix, suffix=_SCRATCH, dir=folder.parent))
    try:
        scratch.chmod(0o777 & ~_umask())
        yield scratch
    finally:
        shutil.rmtree(scratch, ignore_errors=True)


def _remove_leftovers(folder: Path) -> None:
    """Remove scratch folders of runs that were killed while they wrote this map."""
    for left in sorted(folder.parent.glob(f".{glob.escape(folder.name)}.*{_SCRATCH}")):
        writer = left.name.removeprefix(f".{folder.name}.").partition(".")[0]
        if writer.isdigit() and not _alive(int(writer)):
            shutil.rmtree(left, ignore_errors=True)


def _alive(process: int) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except PermissionError:
        return True
    return True


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask


def put_in_place(new: Path, folder: Path) -> None:
    """Make `new` the folder; whenever it is killed, the folder is the old one or the new one.

    What it held before is then at `new`, for the caller to remove.
    """
    sync(new)
    if not folder.exists():
        new.rename(folder)
    elif not _exchange(new, folder):
        _swap_by_renames(new, folder)
    with suppress(OSError):
        _sync_path(folder.parent)


def _exchange(a: Path, b: Path) -> bool:
    """Swap two folders in one step, as Linux can; False where the system or disk can't."""
    renameat2 = getattr(ctypes.CDLL(None, use_errno=True), "renameat2", None)
    if renameat2 is None:
        return False
    done = renameat2(_AT_FDCWD, os.fsencode(a), _AT_FDCWD, os.fsencode(b), _RENAME_EXCHANGE)
    return bool(done == 0)


def _swap_by_renames(new: Path, folder: Path) -> None:
    """Two renames: between them the old map stands beside its place, under a telling name."""
    aside = folder.with_name(f"{folder.name}.before-{os.getpid()}")
    folder.rename(aside)
    try:
        new.rename(folder)
    except OSError:
        aside.rename(folder)
        raise
    aside.rename(new)


def sync(folder: Path) -> None:
    """Force a folder's files to the disk, so that a power cut can't leave empty ones."""
    for path in sorted(folder.rglob("*")):
        _sync_path(path)
    _sync_path(folder)


def _sync_path(path: Path) -> None:
    handle = os.open(path, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)


def carry_over(old: Path, new: Path, written_before: frozenset[str]) -> None:
    """Copy what someone else put into the old map folder; afkb's own files are written anew."""
    for entry in sorted(old.iterdir()):
        target = new / entry.name
        if entry.name in written_before or target.exists():
            continue
        if entry.is_dir() and not entry.is_symlink():
            shutil.copytree(entry, target, symlinks=True)
        else:
            shutil.copy2(entry, target, follow_symlinks=False)
