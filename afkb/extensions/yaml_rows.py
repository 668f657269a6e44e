"""An extension in YAML as rows of the ontology's tables."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from afkb.csv_rows import Row
from afkb.errors import KnowledgeError
from afkb.extensions.problems import Problems
from afkb.extensions.sheet import ALL_TABLES, NAMESPACE, Sheet, number
from afkb.extensions.sheet import Entry as SheetEntry
from afkb.extensions.yaml_model import (
    SECTIONS,
    Category,
    Entry,
    EvidenceClass,
    Extension,
    Feature,
    Room,
)
from afkb.extensions.yaml_reading import Document, Path_, read_yaml
from afkb.extensions.yaml_validation import validated
from afkb.ontology.names import ONTOLOGY_IRI
from afkb.ontology.notation import read_afbit

_TABLE_OF = {"groups": "category_groups"}
_PAIRS = {
    "distance_m": ("distance_mean_m", "distance_sd_m"),
    "size_m": ("size_x_typical_m", "size_y_typical_m"),
}
_COLUMNS = {"evidence_bottom_m": "evidence_bottom_min_m"}
_OWN_ROWS = {"afbits", "parameters", "holds", "counts", "elsewhere"}
"""Keys that become rows of other tables."""


def yaml_sheet(file: Path, problems: Problems) -> Sheet:
    """The rows of an extension in YAML; what is wrong goes to `problems`, then there are none."""
    document = read_yaml(file, problems)
    extension = validated(document, problems)
    if extension is None:
        return Sheet(file, "", "", "", "")
    sheet = Sheet(
        file=file,
        name=extension.extension,
        iri=extension.iri or NAMESPACE.format(extension.extension),
        label=extension.label or extension.extension,
        definition=extension.definition or "",
        license=extension.license or "",
    )
    sheet.entries = list(_Rows(document, extension, problems).entries())
    sheet.elsewhere = {
        name: entry.elsewhere
        for name, entry in extension.evidence_classes.items()
        if entry.elsewhere is not None
    }
    if sheet.iri.startswith(ONTOLOGY_IRI):
        problems.add(
            document.place("iri"),
            f"iri: {sheet.iri} is the ontology's own; choose one, as in https://example.org/home#",
        )
    for index, home in enumerate(extension.homes):
        path = file.parent / home
        if not path.is_file():
            problems.add(document.place("homes", index), f"homes: no file {home} beside this one")
        sheet.homes.append(path)
    return sheet


class _Rows:
    """Makes the rows of one document."""

    def __init__(self, document: Document, extension: Extension, problems: Problems) -> None:
        self._document = document
        self._extension = extension
        self._problems = problems

    def entries(self) -> Iterator[SheetEntry]:
        """Every row that the extension states, in the order of its sections."""
        for section in SECTIONS:
            for name, entry in getattr(self._extension, section).items():
                yield self._entry(section, name, entry)
                yield from self._rows_below(section, name, entry)
        yield from self._afbits(("afbits",), self._extension.afbits)

    def _entry(self, section: str, name: str, entry: Entry) -> SheetEntry:
        path = (section, name)
        cells: dict[str, str] = {"name": name}
        lines: dict[str, int] = {}
        for key, value in entry.model_dump(exclude_none=True).items():
            if key in _OWN_ROWS and not (section == "parameters" and key == "value"):
                continue
            for column, cell in _cells(key, value):
                cells[column] = cell
                lines[column] = self._document.line((*path, key))
        return self._row(_TABLE_OF.get(section, section), cells, path, lines)

    def _rows_below(self, section: str, name: str, entry: Entry) -> Iterator[SheetEntry]:
        path = (section, name)
        said = _provenance(entry)
        if isinstance(entry, Category):
            yield from self._afbits((*path, "afbits"), entry.afbits, name, said)
        elif isinstance(entry, Feature):
            for parameter, four in entry.parameters.items():
                cells = dict(zip(("z1", "n1", "n2", "z2"), map(number, four), strict=True))
                cells |= {"feature": name, "parameter_name": parameter} | said
                yield self._row("trapezoids", cells, (*path, "parameters", parameter))
        elif isinstance(entry, Room):
            for evidence, count in entry.holds.items():
                cells = _count(name, evidence, count)
                yield self._row("room_evidence", cells | said, (*path, "holds", evidence))
        elif isinstance(entry, EvidenceClass):
            for room, count in entry.counts.items():
                cells = _count(room, name, count)
                yield self._row("room_evidence", cells | said, (*path, "counts", room))

    def _afbits(
        self,
        path: Path_,
        lines: list[str],
        category: str = "",
        said: Mapping[str, str] | None = None,
    ) -> Iterator[SheetEntry]:
        for index, line in enumerate(lines):
            place = self._document.place(*path, index)
            try:
                cells = read_afbit(_whole(line, category))
            except KnowledgeError as error:
                self._problems.add(place, str(error))
                continue
            yield self._row("afbits", {**cells, **(said or {})}, (*path, index))

    def _row(
        self, table: str, cells: dict[str, str], path: Path_, lines: Mapping[str, int] | None = None
    ) -> SheetEntry:
        extension = self._extension
        provenance = {
            "status": extension.status or "proposed",
            "source": extension.source or self._document.file.name,
        }
        row = Row(self._document.file.name, self._document.line(path), provenance | cells)
        return SheetEntry(ALL_TABLES[table], row, lines or {})


def _cells(key: str, value: Any) -> Iterator[tuple[str, str]]:
    if key in _PAIRS:
        yield from zip(_PAIRS[key], map(number, value), strict=True)
    elif isinstance(value, list) and key.endswith(("_m", "_kg")):
        what, _, unit = key.rpartition("_")
        for end, limit in zip(("min", "max"), value, strict=True):
            if limit is not None:
                yield f"{what}_{end}_{unit}", number(limit)
    elif isinstance(value, list):
        if value:
            yield key, "|".join(value)
    elif isinstance(value, float | int):
        yield _COLUMNS.get(key, key), number(value)
    else:
        yield key, " ".join(str(value).split())


def _count(room: str, evidence: str, count: float) -> dict[str, str]:
    return {"room": room, "evidence_class": evidence, "expected_count": number(count)}


def _provenance(entry: Entry) -> dict[str, str]:
    return {k: str(v) for k, v in (("status", entry.status), ("source", entry.source)) if v}


def _whole(line: str, category: str) -> str:
    """`SupportAbility = 0.9` or `/HandlePart > … = 0.8` as said of a category."""
    if not category:
        return line
    text = line.strip()
    if text.startswith("/"):
        return f"{category}{text}"
    return text if ">" in text else f"{category} > {text}"
