"""The page's own files: scripts, style and HTML, to be served or written into one page."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from string import Template

_FOLDER = Path(__file__).parent / "assets"
_MEDIA = {
    ".css": "text/css; charset=utf-8",
    ".html": "text/html; charset=utf-8",
    ".js": "text/javascript; charset=utf-8",
}
_IMPORT = re.compile(r'^import .* from "\./([\w-]+\.js)";\n', re.MULTILINE)
_EXPORT = re.compile(r"^export (?=const|class|function|async)", re.MULTILINE)


def asset_names() -> tuple[str, ...]:
    """The files that a server of the page may hand out."""
    return tuple(sorted(p.name for p in _FOLDER.iterdir() if p.suffix in _MEDIA))


def asset(name: str) -> tuple[bytes, str]:
    """Content and media type of one of `asset_names`; `KeyError` for anything else."""
    if name not in asset_names():
        raise KeyError(name)
    content = (_FOLDER / name).read_bytes()
    if name == "serve.html":
        board = Template(part("board.html")).substitute(plan="")
        content = Template(content.decode()).substitute(board=board).encode()
    return content, _MEDIA[Path(name).suffix]


def part(name: str) -> str:
    """The text of a file, as a template for `string.Template` where it is HTML."""
    return (_FOLDER / name).read_text(encoding="utf-8")


def inline_style() -> str:
    """The style for a page that is one file."""
    return part("page.css")


def inline_script(entry: str) -> str:
    """A module and all that it imports as one, for a page that opens from disk.

    A browser loads no module from a file beside the page, so they are joined: imports first, each
    once. They share one scope, and therefore no two may name the same thing at their top.
    """
    return "".join(
        _EXPORT.sub("", _IMPORT.sub("", part(name))) for name in dict.fromkeys(_with_imports(entry))
    )


def _with_imports(entry: str) -> Iterator[str]:
    for name in _IMPORT.findall(part(entry)):
        yield from _with_imports(name)
    yield entry
