"""The terms that an extension may name: what the ontology and the files before it define."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path

from afkb.csv_rows import Row
from afkb.ontology.names import AFN, Names
from afkb.ontology.tables import read_table

WORD_OF = {
    "StructuralAffordance": "feature",
    "MaterialAffordance": "feature",
    "GraspAffordance": "feature",
    "ObjectCategory": "category",
    "CategoryGroup": "group",
    "Scale": "scale",
    "Shape": "shape",
    "Material": "material",
    "Trait": "trait",
    "ObjectPart": "part",
    "Pose": "pose",
    "RoomCategory": "room",
    "EvidenceClass": "evidence class",
    "AfbitRule": "rule",
    "Measure": "measure",
    "Dual": "dual",
    "CoOccurrence": "co-occurrence",
    "NetworkParameter": "parameter",
}
"""Class of the ontology to the word for its individuals."""
_TABLES = {
    "features": "feature", "categories": "category", "category_groups": "group",
    "scales": "scale", "shapes": "shape", "materials": "material", "traits": "trait",
    "parts": "part", "poses": "pose", "rooms": "room", "evidence_classes": "evidence class",
    "rules": "rule", "duals": "dual", "co_occurrences": "co-occurrence",
    "parameters": "parameter", "measures": "measure",
}  # fmt: skip


@dataclass(frozen=True, slots=True)
class Term:
    """A term that is defined: what it is, where, and for a category what it is a kind of."""

    name: str
    iri: str
    word: str
    place: str
    broader: str = ""
    scale: str = ""
    kind: str = ""


@dataclass(frozen=True, slots=True)
class ScaleLimits:
    """A scale with the largest extents that it holds, m."""

    name: str
    least_m: float
    greatest_m: float


@dataclass(slots=True)
class Terms:
    """Terms by what they are and by name, and the statements that have a key.

    `stated`: the keys of afbits, room evidence and trapezoids, with their places.
    `measures`: name, as fuzzy ranges have it, to what has the measure.
    """

    by_word: dict[str, dict[str, Term]] = field(default_factory=dict)
    scales: list[ScaleLimits] = field(default_factory=list)
    stated: dict[tuple[str, ...], str] = field(default_factory=dict)
    measures: dict[str, tuple[str, ...]] = field(default_factory=dict)

    def add(self, term: Term) -> None:
        """Add a term; the first of a name is kept."""
        self.by_word.setdefault(term.word, {}).setdefault(term.name, term)

    def get(self, name: str, *words: str) -> Term | None:
        """The term of that name that is one of those words."""
        return next((t for w in words if (t := self.by_word.get(w, {}).get(name))), None)

    def names(self, *words: str) -> set[str]:
        """The names of the terms that are one of those words."""
        return {name for word in words for name in self.by_word.get(word, {})}

    def all(self) -> Iterable[Term]:
        """Every term."""
        return (term for terms in self.by_word.values() for term in terms.values())

    def resolver(self, own: str, new: Iterable[str]) -> Names:
        """The IRIs of names, for a file whose namespace is `own` and whose own terms are `new`."""
        known: dict[str, str] = {}
        for term in self.all():
            if not term.iri.startswith(AFN):
                known[term.name] = term.iri
                known[f"{term.name}Entity"] = f"{term.iri}Entity"
        for name in new:
            known |= {name: own + name, f"{name}Entity": f"{own}{name}Entity"}
        return Names(own, known)

    def copy(self) -> Terms:
        """Terms to which others can be added."""
        words = {word: dict(terms) for word, terms in self.by_word.items()}
        return Terms(words, list(self.scales), dict(self.stated), dict(self.measures))


def bundled_terms(ontology: Path) -> Terms:
    """The terms of the bundled ontology, from the tables beside it: quicker than from its OWL.

    A row of a table that is not in the ontology yet is left out.
    """
    text = ontology.read_text(encoding="utf-8")
    stated = set(re.findall(rf'rdf:about="{re.escape(AFN)}([^"]+)"', text))
    terms = Terms()
    for table, word in _TABLES.items():
        for row in read_table(ontology.parent / "tables", table):
            if row["name"] in stated:
                _take_in(row, word, terms)
    terms.stated = {
        tuple(name.split(".")): "the bundled ontology" for name in stated if "." in name
    }
    return terms


def _take_in(row: Row, word: str, terms: Terms) -> None:
    place = f"the bundled ontology ({row.place})"
    cells = {c: row.get(c) for c in ("broader", "scale", "kind")}
    terms.add(Term(row["name"], AFN + row["name"], word, place, **cells))
    if word == "measure":
        terms.measures[row["measure_name"]] = tuple(row.several("measure_of"))
    if word == "scale":
        limits = row.get("extent_min_m"), row.get("extent_max_m")
        terms.scales.append(scale_limits(row["name"], *limits))


def scale_limits(name: str, least: str, greatest: str) -> ScaleLimits:
    """A scale from the texts of its limits; what is left out is without end."""
    return ScaleLimits(name, float(least or 0.0), float(greatest or math.inf))
