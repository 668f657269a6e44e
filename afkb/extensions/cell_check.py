"""Checks the cells of an extension's rows by themselves: names, words and what must be filled."""

from __future__ import annotations

import re

from afkb.extensions.problems import Problems, nearest
from afkb.extensions.sheet import Entry, Sheet
from afkb.ontology.names import GROUNDED_BY, KINDS, RELATIONS, STATUSES, SUBJECTS

_NAME = re.compile(r"[A-Z][A-Za-z0-9_]*")
_MEASURE = re.compile(r"[a-z][A-Za-z0-9_]*")
_WORDS = {
    "status": STATUSES,
    "grounding_status": STATUSES,
    "moved": ("Fixed", "Rarely", "Often", "Carried", "RarelyMoved", "OftenMoved"),
    "stands_on": ("Floor", "Support", "Wall", "Structure", "Anything"),
    "relation": RELATIONS,
    "measure_of": SUBJECTS,
    "grounded_on": SUBJECTS,
    "grounded_by": GROUNDED_BY,
}
"""Columns that hold one of a few words, or several of them."""
_NEEDED = {
    "features": ("kind",),
    "categories": ("broader", "length", "width", "height"),
    "afbits": ("strength",),
    "duals": ("evidence", "predicted", "relation", "strength", "predicted_scale"),
    "co_occurrences": ("feature", "strength", "predicted_scale"),
    "evidence_classes": ("feature",),
    "room_evidence": ("expected_count",),
    "measures": ("measure_name", "measure_of"),
    "trapezoids": ("z1", "n1", "n2", "z2"),
    "parameters": ("value",),
}


def check_cells(sheet: Sheet, problems: Problems) -> None:
    """Note rows without a name or with a bad one, odd words, and cells that must be filled."""
    for entry in sheet.entries:
        for column in entry.table.parts or ("name",):
            if column != "part":
                _check_filled(entry, column, problems)
        name = entry.row.get("name")
        if not entry.table.parts and name and not _NAME.fullmatch(name):
            problems.add(
                entry.row.place,
                f"the name {name!r} is not of that form; write {_camel(name)!r}: letters and "
                "digits, a capital first",
            )
        _check_entity(entry, name, problems)
        measure = entry.row.get("parameter_name")
        if measure and not _MEASURE.fullmatch(measure):
            problems.add(
                entry.row.place,
                f"the measure {measure!r} is not of that form; write it with its unit, as in "
                "height_m",
            )
        for column in _NEEDED.get(entry.table.name, ()):
            for needed in _ends(column):
                _check_filled(entry, needed, problems)
        _check_words(entry, problems)


def _check_entity(entry: Entry, name: str, problems: Problems) -> None:
    if entry.table.name in ("categories", "category_groups") and name.endswith("Entity"):
        problems.add(
            entry.row.place,
            f"the name {name!r} ends as those of classes do; leave `Entity` out of it",
        )


def _ends(column: str) -> tuple[str, ...]:
    return (
        (f"{column}_min_m", f"{column}_max_m")
        if column in ("length", "width", "height")
        else (column,)
    )


def _check_filled(entry: Entry, column: str, problems: Problems) -> None:
    if not entry.row.get(column):
        name = entry.row.get("name")
        problems.add(entry.row.place, f"{f'{name}: ' if name else ''}{column} is missing; fill it")


def _check_words(entry: Entry, problems: Problems) -> None:
    words = _WORDS | ({"kind": tuple(KINDS)} if entry.table.name == "features" else {})
    for column, known in words.items():
        for cell in entry.row.several(column):
            if cell not in known:
                mend = nearest(cell, known)
                problems.add(
                    entry.place(column),
                    f"{column} {cell!r} is none of: {', '.join(known[:5])}"
                    + (f"; {mend}" if mend.startswith("did") else "; write one of them"),
                )


def _camel(name: str) -> str:
    return "".join(part[:1].upper() + part[1:] for part in re.findall(r"[A-Za-z0-9]+", name)) or "X"
