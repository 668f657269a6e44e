"""Rules that make afbits: what follows for a category from its tokens and measures."""

from __future__ import annotations

import operator
import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass

from afkb.csv_rows import Row
from afkb.ontology.subjects import OWN_FAMILIES, Subject

_MEASURE = re.compile(r"(\w+)(<=|>=|<|>)([0-9.]+)")
_COMPARE: dict[str, Callable[[float, float], bool]] = {
    "<": operator.lt, "<=": operator.le, ">": operator.gt, ">=": operator.ge,
}  # fmt: skip
_TOKEN = re.compile(r"[a-z_]+:[^\s]+")
PROJECT = "project"
"""The family of what this project's own tables say."""


@dataclass(frozen=True, slots=True)
class Rule:
    """One row of a table of rules.

    `needs`: tokens and measures that must all hold. `any_of`: tokens of which `least` different
    families must speak. `unless`: tokens and measures none of which may hold. `backing`: tokens
    that speak for what the rule says, and alone make nothing.
    """

    row: Row
    needs: tuple[str, ...]
    any_of: tuple[str, ...]
    unless: tuple[str, ...]
    backing: tuple[str, ...]
    least: int

    @classmethod
    def read(cls, row: Row) -> Rule:
        """The rule of a row; `KnowledgeError`, with its place, for words that mean nothing."""
        columns = [
            tuple(row.get(column).split()) for column in ("needs", "any_of", "unless", "backing")
        ]
        for word in (w for column in columns for w in column):
            if not (_MEASURE.fullmatch(word) or _TOKEN.fullmatch(word)):
                raise row.error(f"{word!r} is neither family:word nor a measure as in width_m<0.1")
        if not columns[0] and not columns[1]:
            raise row.error("a rule needs something: fill needs or any_of")
        needs, any_of, unless, backing = columns
        least = int(row.number("least")) if row.get("least") else 1
        return cls(row, needs, any_of, unless, backing, least)

    @property
    def name(self) -> str:
        """The rule's name."""
        return self.row["name"]

    def evidence(self, subject: Subject) -> dict[str, str] | None:
        """The tokens that made the rule hold, with their places; None where it doesn't hold."""
        if not all(_holds(w, subject) for w in self.needs):
            return None
        if any(_holds(w, subject) for w in self.unless):
            return None
        spoken = {w: subject.tokens[w] for w in self.any_of if w in subject.tokens}
        if self.any_of and len({family_of(w) for w in spoken}) < self.least:
            return None
        said = (*self.needs, *self.backing)
        return {w: subject.tokens[w] for w in said if w in subject.tokens} | spoken


def read_rules(rows: Iterable[Row]) -> list[Rule]:
    """The rules of a table."""
    return [Rule.read(row) for row in rows]


def family_of(token: str) -> str:
    """Whose word a token is: a public table, or this project."""
    family = token.split(":", 1)[0]
    return PROJECT if family in OWN_FAMILIES else family


def _holds(word: str, subject: Subject) -> bool:
    match = _MEASURE.fullmatch(word)
    if match is None:
        return word in subject.tokens
    measure = subject.measures.get(match[1])
    return measure is not None and _COMPARE[match[2]](measure, float(match[3]))
