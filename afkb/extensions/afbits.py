"""The afbits of an extension: its own, and those that the rules make for its categories."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

from afkb.csv_rows import Row
from afkb.extensions.sheet import Sheet, rows_of
from afkb.extensions.terms import Terms
from afkb.ontology.afbits import DrawnAfbit, draw_afbits, whole_afbits
from afkb.ontology.rules import Rule, read_rules
from afkb.ontology.subjects import Subject, read_subjects
from afkb.ontology.tables import read_table


def afbit_rows(sheet: Sheet, known: Terms, tables: Path) -> list[Row]:
    """A row for each afbit of a sheet, each at the place of the extension that it follows from.

    Own afbits take precedence over what rules say of the same affordance, by the same part or of
    the thing as a whole; strength 0 takes one away. `tables`: the folder that holds the rules.
    """
    own = rows_of(sheet.of("afbits"))
    kinds = _kinds(known)
    subjects = _subjects(sheet, known)
    new = {subject.name for subject in subjects}
    drawn = draw_afbits(
        subjects, kinds, _rules(sheet, tables), [row for row in own if row["category"] in new]
    )
    others = [row for row in own if row["category"] not in new]
    named = dict.fromkeys(row["category"] for row in others)
    drawn += draw_afbits([_bundled(name, known) for name in named], kinds, [], others)
    return [_placed(afbit) for afbit in _kept(drawn)]


def _subjects(sheet: Sheet, known: Terms) -> list[Subject]:
    """The categories of the sheet, with everything that is broader than they are."""
    own = rows_of(sheet.of("categories"))
    names = {row["name"] for row in own}
    broader = [
        Row("", 0, {"name": term.name, "broader": term.broader})
        for word in ("category", "group")
        for term in known.by_word.get(word, {}).values()
        if term.name not in names
    ]
    return read_subjects(own, broader, [])


def _rules(sheet: Sheet, tables: Path) -> list[Rule]:
    return read_rules([*read_table(tables, "rules"), *rows_of(sheet.of("rules"))])


def _bundled(name: str, known: Terms) -> Subject:
    term = known.by_word["category"][name]
    return Subject(Row("", 0, {"name": name, "scale": term.scale or "Medium"}), {})


def _kept(afbits: Sequence[DrawnAfbit]) -> Iterator[DrawnAfbit]:
    whole = {(a.key[0], a.key[2]) for a in afbits if a.stated is not None and not a.key[1]}
    for afbit in afbits:
        overruled = afbit.stated is None and (afbit.key[0], afbit.key[2]) in whole
        denied = afbit.stated is not None and afbit.stated.number("strength") == 0
        if not overruled and not denied:
            yield afbit


def _placed(afbit: DrawnAfbit) -> Row:
    """The row of an afbit; one that a rule makes stands where its category does."""
    row = afbit.row()
    place = afbit.stated or afbit.subject.row
    return Row(place.table, place.line, row.cells)


def own_afbits(rows: Iterable[Row], sheet: Sheet, known: Terms, tables: Path) -> list[Row]:
    """The rows of structural and material afbits that are met as the thing's own."""
    parts = [*read_table(tables, "parts"), *rows_of(sheet.of("parts"))]
    return whole_afbits(rows, parts, _kinds(known))


def _kinds(known: Terms) -> dict[str, str]:
    """Feature to structural, material or grasp."""
    return {name: term.kind for name, term in known.by_word.get("feature", {}).items()}
