"""Stacks extensions: each file is read and checked against those that are read before it.

    graph = extension_graph(Path("my-home.yaml"))

Files build on each other: each may name the terms of those that are read before it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path

from rdflib import Graph

from afkb.errors import KnowledgeError
from afkb.extensions.cell_check import check_cells
from afkb.extensions.defaults import complete
from afkb.extensions.owl_reading import owl_statements
from afkb.extensions.problems import Problems
from afkb.extensions.sheet import Sheet
from afkb.extensions.sheet_graph import names_in, sheet_graph
from afkb.extensions.statement_check import check_statements
from afkb.extensions.statements import of_sheet, terms_of
from afkb.extensions.table_rows import tables_sheet
from afkb.extensions.terms import Terms, bundled_terms
from afkb.extensions.yaml_rows import yaml_sheet
from afkb.ontology.bundled import bundled_ontology
from afkb.ontology.categories import completed
from afkb.ontology.heights import with_undersides
from afkb.ontology.rdf_files import RDF_FORMATS

YAML_SUFFIXES = (".yaml", ".yml")
SUFFIXES = (*YAML_SUFFIXES, ".csv", *RDF_FORMATS)


def extension_graph(path: Path, earlier: Sequence[Path] = ()) -> Graph:
    """What an extension in YAML or tables states, with the afbits that the rules make for it.

    `earlier`: what is read before it, the ontology first; nothing means the bundled ontology.
    Raises one `KnowledgeError` that has a line for each problem, with file and mend.
    """
    stack = _Stack(earlier[0] if earlier else None)
    for file in earlier[1:]:
        stack.add(file)
    sheet = stack.add(path)
    if sheet is None:
        raise KnowledgeError(f"{path}: OWL is read as it stands; give YAML or tables")
    return sheet_graph(sheet, stack.terms, stack.tables)


def read_stack(files: Sequence[Path]) -> dict[Path, Graph]:
    """What extensions in YAML or tables state, read one after another with those in OWL.

    `files`: the ontology and its extensions, in order; one that is given again, as a plugin's may
    be, is read once. Raises one `KnowledgeError` that has a line for everything that is wrong in
    any of them, OWL files included.
    """
    stack = _Stack(files[0] if files else None)
    graphs: dict[Path, Graph] = {}
    found: list[str] = []
    for path in _once(files[1:]):
        try:
            sheet = stack.add(path)
            if sheet is not None:
                graphs[path] = sheet_graph(sheet, stack.terms, stack.tables)
        except KnowledgeError as error:
            found += str(error).splitlines()
    if found:
        raise KnowledgeError("\n".join(found))
    return graphs


def _once(files: Sequence[Path]) -> list[Path]:
    """The files without those that are the same, or have the same content, as one before."""
    seen: set[object] = set()
    found = []
    for path in files:
        key = path.read_bytes() if path.is_file() else path.resolve()
        if key not in seen:
            found.append(path)
        seen.add(key)
    return found


def extension_homes(path: Path) -> list[Path]:
    """The tables of what homes hold that an extension brings, for the figures."""
    if path.suffix in RDF_FORMATS:
        return []
    problems = Problems(path.parent)
    sheet = _sheet(path, bundled_ontology().parent / "tables", problems)
    problems.raise_any()
    return sheet.homes


def files_behind(files: Sequence[Path]) -> list[Path]:
    """The files and the tables of homes that they bring: all that decides what is read.

    A file that can't be read brings none; whoever reads it says why.
    """
    found = list(files)
    for path in files[1:]:
        try:
            found += [home for home in extension_homes(path) if home.is_file()]
        except (KnowledgeError, OSError):
            continue
    return found


class _Stack:
    """The terms that are known so far, file by file."""

    def __init__(self, ontology: Path | None) -> None:
        bundled = bundled_ontology()
        self.tables = bundled.parent / "tables"
        if ontology is None or ontology.resolve() == bundled.resolve():
            self.terms = _bundled_terms(bundled, bundled.stat().st_mtime_ns)
        else:
            self.terms = terms_of(owl_statements(ontology))

    def add(self, path: Path) -> Sheet | None:
        """Check a file and take in its terms; its rows, or None for OWL."""
        problems = Problems(path.parent)
        sheet = None
        if path.suffix in RDF_FORMATS:
            statements = owl_statements(path)
        else:
            sheet = _checked_sheet(path, self.terms, self.tables, problems)
            statements = of_sheet(sheet, names_in(sheet, self.terms), problems)
        self.terms = check_statements(statements, self.terms, problems)
        problems.raise_any()
        return sheet


@cache
def _bundled_terms(ontology: Path, changed_ns: int) -> Terms:
    return bundled_terms(ontology)


def _checked_sheet(path: Path, terms: Terms, tables: Path, problems: Problems) -> Sheet:
    sheet = _sheet(path, tables, problems)
    problems.raise_any()
    complete(sheet, terms)
    check_cells(sheet, problems)
    problems.raise_any()
    sheet.entries = [
        replace(e, row=with_undersides([completed(e.row)])[0])
        if e.table.name == "categories"
        else e
        for e in sheet.entries
    ]
    return sheet


def _sheet(path: Path, tables: Path, problems: Problems) -> Sheet:
    """The rows of a file; without any, `problems` say why."""
    if not path.exists():
        raise KnowledgeError(f"{path}: no such extension; write one with `afkb ontology new`")
    if path.is_dir() or path.suffix == ".csv":
        return tables_sheet(path, tables, problems)
    if path.suffix in YAML_SUFFIXES:
        return yaml_sheet(path, problems)
    raise KnowledgeError(
        f"{path}: no extension: files of an ontology end in {', '.join(SUFFIXES)}; rename it"
    )
