"""The recordings of a batch and what their maps are called."""

from __future__ import annotations

import glob
import re
from collections import Counter
from collections.abc import Iterable, Sequence
from pathlib import Path

from afkb.errors import SourceError

_NAMED = re.compile(r"(?P<name>[A-Za-z0-9][\w.-]*)=(?P<source>.+)", re.DOTALL)
_SUFFIXES = re.compile(r"(?<=.)(\.[A-Za-z][A-Za-z0-9]{0,7})+$")
_UNUSUAL = re.compile(r"[^\w.-]+")


def recordings(arguments: Sequence[str], listed: Iterable[str] = ()) -> dict[str, str]:
    """Name of the map to recording, in their order.

    Each argument is a path or URI, a pattern of paths (`homes/*/bag`), or `NAME=` and one of them;
    lines of a list are the same, `#` begins a comment. A map is called what its recording is;
    recordings that are called the same get their folders' names before theirs. `SourceError` where
    a pattern finds nothing, a name is given twice, or the same recording is.
    """
    lines = (line.partition("#")[0].strip() for line in listed)
    named: dict[str, str] = {}
    found: list[str] = []
    for written in (*arguments, *filter(None, lines)):
        given = None if Path(written).exists() else _NAMED.fullmatch(written)
        if given is None:
            found += _expanded(written)
        elif given["name"] in named:
            raise SourceError(f"{written}: another recording is called {given['name']!r} already")
        else:
            named[given["name"]] = _absolute(given["source"])
    twice = [uri for uri, n in Counter([*found, *named.values()]).items() if n > 1]
    if twice:
        raise SourceError(f"{twice[0]}: named twice; a recording is mapped once")
    for name, uri in _names(found).items():
        if name in named:
            raise SourceError(f"{uri}: another recording is called {name!r}; write NAME={uri}")
        named[name] = uri
    return named


def _expanded(written: str) -> list[str]:
    if Path(written).exists() or not glob.has_magic(written) or "://" in written:
        return [_absolute(written)]
    matches = sorted(glob.glob(str(Path(written).expanduser())))  # noqa: PTH207 - may be absolute
    if not matches:
        raise SourceError(f"{written}: no file or folder is called so")
    return [_absolute(match) for match in matches]


def _absolute(uri: str) -> str:
    """A path as it is known from every folder; a URI as it is."""
    path = Path(uri).expanduser()
    return str(path.absolute()) if path.exists() else uri


def _names(uris: Sequence[str]) -> dict[str, str]:
    """Each recording's last part, with as many of its folders before as tell it from the others."""
    parts = [_parts(uri) for uri in uris]
    used = [1] * len(uris)
    while True:
        names = ["-".join(p[-n:]) for p, n in zip(parts, used, strict=True)]
        count = Counter(names)
        longer = [
            n + (count[name] > 1 and n < len(p))
            for p, n, name in zip(parts, used, names, strict=True)
        ]
        if longer == used:
            break
        used = longer
    same = next((uri for uri, name in zip(uris, names, strict=True) if count[name] > 1), None)
    if same is not None:
        raise SourceError(f"{same}: another recording's map would be called the same; NAME={same}")
    return dict(zip(names, uris, strict=True))


def _parts(uri: str) -> list[str]:
    """The words of a path or URI that may stand in a folder's name; no suffix on the last."""
    words = [w for w in re.split(r"[/:]+", uri) if w.strip(".")]
    words[-1:] = [_SUFFIXES.sub("", words[-1])] if words else ["recording"]
    return [_UNUSUAL.sub("-", word).strip("-") or "recording" for word in words]
