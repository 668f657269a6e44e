"""Starters: files to begin an extension with, which pass the check as they are."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path

from afkb.errors import KnowledgeError
from afkb.ontology.names import slug

_FOLDER = Path(__file__).parent / "files"


class Kind(StrEnum):
    """What an extension may be written in."""

    YAML = "yaml"
    TABLE = "table"
    OWL = "owl"


_SUFFIXES = {Kind.YAML: (".yaml", ".yml"), Kind.TABLE: (".csv", ""), Kind.OWL: (".owl", ".rdf")}


def kind_of(path: Path) -> Kind:
    """The kind that the end of a name tells; `KnowledgeError` where it tells none."""
    for kind, suffixes in _SUFFIXES.items():
        if path.suffix in suffixes:
            return kind
    raise KnowledgeError(
        f"{path}: its name does not tell what to write; end it in .yaml, .csv or .owl, or leave "
        "the end out for a folder of tables"
    )


def write_starter(path: Path, kind: Kind | None = None) -> list[Path]:
    """Write a starter and return its files; `KnowledgeError` where something is there already.

    Tables are written as one file where the name ends in .csv, else as a folder of them.
    """
    told = kind_of(path)
    if kind is not None and kind is not told:
        ends = " or ".join(end or "nothing" for end in _SUFFIXES[kind])
        raise KnowledgeError(f"{path}: for --kind {kind.value}, end the name in {ends}")
    if path.exists():
        raise KnowledgeError(f"{path}: is there already; choose another name, or remove it")
    try:
        if told is Kind.TABLE and not path.suffix:
            path.mkdir(parents=True)
            sources = sorted((_FOLDER / "tables").iterdir())
            return [_write(source, path / source.name, path) for source in sources]
        source = {
            Kind.YAML: _FOLDER / "extension.yaml",
            Kind.TABLE: _FOLDER / "tables" / "categories.csv",
            Kind.OWL: _FOLDER / "extension.owl",
        }[told]
        return [_write(source, path, path)]
    except OSError as error:
        raise KnowledgeError(f"{path}: can't be written: {error.strerror}") from error


def _write(source: Path, out: Path, named: Path) -> Path:
    text = source.read_text(encoding="utf-8")
    text = text.replace("{name}", slug(named.stem)).replace("{file}", named.name)
    with out.open("x", encoding="utf-8", newline="") as file:
        try:
            file.write(text)
            file.flush()
        except BaseException:
            out.unlink(missing_ok=True)
            raise
    return out
