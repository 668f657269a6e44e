"""Gathers what public tables say of the categories, as evidence for the rules that make afbits."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from afkb.csv_rows import Row, csv_text, read_rows
from afkb.errors import KnowledgeError

_WORDNET = re.compile(r"wn:([\w'.-]+?\.n\.\d\d)")
HEADER = ("category", "source", "property", "name", "found_in")
_ENOUGH = 0.5
"""Share of a category's names in a table that must have a property for the category to have it."""
_ASKED = {"bddl": ("bddl", "wordnet"), "virtualhome": ("virtualhome", "wordnet")}
"""Which tables know a name of a source, where it is not the source's own alone."""


@dataclass(frozen=True, slots=True)
class PublicTable:
    """A public table: name of a thing in it to property to the file and line that say so."""

    source: str
    said: Mapping[str, Mapping[str, str]]


def gather(folder: Path, names: Iterable[Row]) -> dict[str, str]:
    """Evidence per public table as CSV text, from a folder of public tables.

    `names`: rows of category, source, name. A name that its table doesn't have is a
    `KnowledgeError` with the row's place.
    """
    tables = {
        "virtualhome": _virtualhome(folder),
        "bddl": _bddl(folder),
        "wordnet": _wordnet(folder),
        "procthor": _procthor(folder),
    }
    wanted: dict[tuple[str, str], list[Row]] = {}
    for row in names:
        for source in _ASKED.get(row["source"], (row["source"],)):
            optional = source == "wordnet" and row["name"] not in tables["wordnet"].said
            if source in tables and not optional:
                wanted.setdefault((source, row["category"]), []).append(row)
    lines: dict[str, list[tuple[str, ...]]] = {source: [] for source in tables}
    for (source, category), rows in sorted(wanted.items()):
        lines[source] += _evidence(tables[source], category, rows)
    return {source: csv_text(HEADER, found) for source, found in lines.items()}


def _evidence(table: PublicTable, category: str, rows: list[Row]) -> Iterator[tuple[str, ...]]:
    counts: Counter[str] = Counter()
    for row in rows:
        if row["name"] not in table.said:
            raise row.error(f"{table.source} has nothing named {row['name']!r}; mend the name")
        counts.update(table.said[row["name"]].keys())
    for name in sorted(counts):
        if counts[name] >= _ENOUGH * len(rows):
            said_of = next(r["name"] for r in rows if name in table.said[r["name"]])
            yield category, table.source, name, said_of, table.said[said_of][name]


def _virtualhome(folder: Path) -> PublicTable:
    file = "virtualhome_properties.csv"
    said = {
        row["object"]: dict.fromkeys(row.several("properties"), row.place)
        for row in _rows(folder, file)
    }
    return PublicTable("virtualhome", said)


def _bddl(folder: Path) -> PublicTable:
    properties = {
        row["synset"]: dict.fromkeys(row.several("properties"), row.place)
        for row in _rows(folder, "bddl_synset_properties.csv")
    }
    return PublicTable("bddl", {c: properties.get(s, {}) for c, s in _synsets(folder).items()})


def _wordnet(folder: Path) -> PublicTable:
    """A category's synset and its hypernyms, as far as two tables tell them."""
    above = {
        row["synset"]: ([h.strip() for h in row["hypernyms"].split(",") if h.strip()], row.place)
        for row in _rows(folder, "bddl_synset_properties.csv")
    }
    said = {c: _hypernyms(s, above) for c, s in _synsets(folder).items()}
    for row in _rows(folder, "object_affordance_draft.csv"):
        for hypernym in _WORDNET.findall(row["rule_provenance"]):
            said.setdefault(row["object"], {}).setdefault(hypernym, row.place)
    return PublicTable("wordnet", said)


def _hypernyms(synset: str, above: Mapping[str, tuple[list[str], str]]) -> dict[str, str]:
    found: dict[str, str] = {}
    waiting = [(synset, above[synset][1] if synset in above else "")]
    while waiting:
        name, place = waiting.pop(0)
        if name in found or not place:
            continue
        found[name] = place
        if name in above:
            waiting += [(h, above[name][1]) for h in above[name][0]]
    return found


def _procthor(folder: Path) -> PublicTable:
    said: dict[str, dict[str, str]] = {}
    for row in _rows(folder, "procthor_asset_dims_m.csv"):
        said[row["object_type"]] = {"Asset": row.place}
    for row in _rows(folder, "procthor_receptacle_given.csv"):
        said.setdefault(row["receptacle"], {}).setdefault("Receptacle", row.place)
    for row in _rows(folder, "procthor_placement.csv"):
        for column, name in (("isPickupable", "Pickupable"), ("onWall", "OnWall")):
            if row[column] == "True":
                said.setdefault(row["object"], {})[name] = row.place
    return PublicTable("procthor", said)


def _synsets(folder: Path) -> dict[str, str]:
    rows = _rows(folder, "bddl_category_synset_mass.csv")
    return {row["category"]: row["synset"] for row in rows}


def _rows(folder: Path, file: str) -> Iterator[Row]:
    path = folder / file
    if not path.is_file():
        raise KnowledgeError(f"{path}: missing; give the folder that holds the public tables")
    return read_rows(path, table=file)
