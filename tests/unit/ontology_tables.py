"""A small folder of tables, as the ontology is built from, for tests of rules and afbits."""

from __future__ import annotations

from afkb.csv_rows import Row
from afkb.ontology.subjects import Subject, measures_of

_CUP = {
    "name": "Cup", "scale": "Small", "stands_on": "Support", "moved": "Carried",
    "length_min_m": "0.06", "length_max_m": "0.14", "width_min_m": "0.06", "width_max_m": "0.12",
    "height_min_m": "0.06", "height_max_m": "0.2", "shape": "CylinderShape",
    "materials": "CeramicMaterial|GlassMaterial", "traits": "OpenTop", "broader": "Tableware",
}  # fmt: skip


def row(table: str, line: int = 2, **cells: str) -> Row:
    """A row of that table."""
    return Row(f"{table}.csv", line, cells)


def category(**cells: str) -> Row:
    """A cup's row with these cells changed."""
    return Row("categories/kitchen.csv", 2, _CUP | cells)


def subject(tokens: str = "", **cells: str) -> Subject:
    """A cup as rules see it, with further tokens, each from a place of its own."""
    cup = category(**cells)
    own = ["shape:CylinderShape", "trait:OpenTop", "mainly:CeramicMaterial", "kind:Tableware"]
    places = dict.fromkeys(own, cup.place)
    places |= {token: f"{token.split(':')[0]}.csv, line 7" for token in tokens.split()}
    return Subject(cup, places, measures_of(cup))


def rule(name: str = "OpenTopContains", **cells: str) -> Row:
    """A rule's row: what has an open top contains, unless other cells are given."""
    given = {"needs": "trait:OpenTop"} if not {"needs", "any_of"} & set(cells) else {}
    usual = {"name": name, "feature": "ContainAbility", "part": "BasinPart", "strength": "0.95"}
    return Row("rules/structural.csv", 3, usual | given | cells)
