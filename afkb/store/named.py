"""The library of ready-made queries: `afkb query MAP @containers-on-supports`."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from afkb.errors import QueryError

FOLDER = Path(__file__).parent / "queries"


@dataclass(frozen=True, slots=True)
class NamedQuery:
    """A query of the library: `name` without the @, what it answers, and its text."""

    name: str
    about: str
    sparql: str


def named_queries() -> list[NamedQuery]:
    """Every query of the library, by name; its first comment line says what it answers."""
    return [_read(path) for path in sorted(FOLDER.glob("*.rq"))]


def named_query(name: str) -> NamedQuery:
    """The query of that name, with or without its @; `QueryError` if there is none."""
    path = FOLDER / f"{name.removeprefix('@')}.rq"
    if path.parent != FOLDER or not path.is_file():
        known = ", ".join(f"@{query.name}" for query in named_queries())
        raise QueryError(f"no named query {name!r}; there are: {known}")
    return _read(path)


def _read(path: Path) -> NamedQuery:
    text = path.read_text(encoding="utf-8")
    return NamedQuery(path.stem, text.splitlines()[0].lstrip("# "), text)
