"""Which table becomes which class of individuals, and which column which property."""

from __future__ import annotations

import re
from dataclasses import dataclass, field

from rdflib import Literal, URIRef
from rdflib.namespace import DCTERMS, RDFS, SKOS, XSD

from afkb.csv_rows import Row
from afkb.ontology.names import AFN, BUNDLED, Names

_TEXT = {
    "label": RDFS.label,
    "definition": SKOS.definition,
    "example": SKOS.example,
    "note": SKOS.note,
    "grounding": URIRef(AFN + "grounding"),
    "source": DCTERMS.source,
    "choice": URIRef(AFN + "choice"),
    "grounding_reason": URIRef(AFN + "groundingReason"),
    "underside_from": URIRef(AFN + "undersideFrom"),
}
_PLAIN = {
    "status", "grounding_status", "observability", "stands_on", "parameter_name", "relation",
    "measure_name", "measured_in", "primitive",
}  # fmt: skip
_WORDS = {"measure_of", "grounded_by", "grounded_on"}
"""Columns of several plain words."""
_TERMS = {
    "broader": SKOS.broader,
    "category": URIRef(AFN + "ofCategory"),
    "feature": URIRef(AFN + "ofFeature"),
    "part": URIRef(AFN + "ofPart"),
    "room": URIRef(AFN + "ofRoom"),
    "object": URIRef(AFN + "ofCategory"),
    "given": URIRef(AFN + "givenCategory"),
    "rules": URIRef(AFN + "byRule"),
    "materials": URIRef(AFN + "madeOf"),
    "traits": URIRef(AFN + "hasTrait"),
} | {
    name: URIRef(AFN + re.sub(r"_(.)", lambda m: m[1].upper(), name))
    for name in (
        "scale", "predicted_scale", "movability", "moved", "evidence", "predicted", "shape", "pose",
        "evidence_category", "predicted_category", "predicted_class", "evidence_class",
    )
}  # fmt: skip
_FLAGS = {"whole", "reviewed"}
_WHOLE_NUMBERS = {"independent_sources", "buildings"}
_LISTS = {"examples": SKOS.example}
_SKIPPED = {"name", "kind", "needs", "any_of", "unless", "backing", "least"}


@dataclass(frozen=True, slots=True)
class Table:
    """How a table's rows become individuals.

    `class_name`: the class, or empty where the row's kind tells. `parts`: the columns that name
    a row without a name of its own, with `suffix` behind. `terms`: columns that name other terms
    here only.
    """

    name: str
    class_name: str
    parts: tuple[str, ...] = ()
    terms: dict[str, str] = field(default_factory=dict)
    suffix: str = ""

    def name_of(self, row: Row) -> str:
        """The individual's name: the IRI's fragment."""
        if not self.parts:
            return row["name"]
        cells = [*(row.get(part) for part in self.parts), self.suffix]
        return ".".join(cell for cell in cells if cell)

    def statements(self, row: Row, names: Names = BUNDLED) -> list[tuple[URIRef, URIRef | Literal]]:
        """What the row states of its individual, property and value."""
        return [found for column in row.cells for found in self.cell_states(row, column, names)]

    def cell_states(
        self, row: Row, column: str, names: Names = BUNDLED
    ) -> list[tuple[URIRef, URIRef | Literal]]:
        """What one cell of the row states."""
        cell = row[column]
        if column in _SKIPPED:
            return []
        if column in self.terms:
            return [(URIRef(AFN + self.terms[column]), URIRef(names.iri(cell)))]
        if column in _TEXT:
            return [(_TEXT[column], Literal(cell, lang="en"))]
        if column in _LISTS:
            return [(_LISTS[column], Literal(e, lang="en")) for e in row.several(column)]
        if column in _PLAIN:
            return [(property_of(column), Literal(cell, datatype=XSD.string))]
        if column in _WORDS:
            words = row.several(column)
            return [(property_of(column), Literal(w, datatype=XSD.string)) for w in words]
        if column in _TERMS:
            return [(_TERMS[column], URIRef(names.iri(name))) for name in row.several(column)]
        if column in _FLAGS:
            return [(property_of(column), Literal(cell == "yes", datatype=XSD.boolean))]
        number = row.number(column)
        if column in _WHOLE_NUMBERS:
            return [(property_of(column), Literal(int(number)))]
        return [(property_of(column), Literal(repr(number), datatype=XSD.double))]


CO_OCCURRENCES = Table("co_occurrences", "CoOccurrence")
"""Co-occurrences: rows of a table, and those that were counted in homes."""

TABLES = (
    Table("features", ""),
    Table("measures", "Measure"),
    Table("trapezoids", "Trapezoid", ("feature", "parameter_name")),
    Table("scales", "Scale"),
    Table("shapes", "Shape"),
    Table("materials", "Material"),
    Table("traits", "Trait"),
    Table("parts", "ObjectPart"),
    Table("poses", "Pose"),
    Table("category_groups", "CategoryGroup"),
    Table("categories", "ObjectCategory"),
    Table("rules", "AfbitRule"),
    Table("report_rates", "ReportRate", ("category", "feature"), suffix="Rate"),
    Table("duals", "Dual"),
    Table("evidence_classes", "EvidenceClass"),
    CO_OCCURRENCES,
    Table("rooms", "RoomCategory"),
    Table(
        "room_evidence",
        "RoomEvidence",
        ("room", "evidence_class"),
        {"evidence_class": "ofEvidenceClass"},
    ),
    Table("parameters", "NetworkParameter"),
)
"""The tables whose rows are taken as they stand, in the order in which they are read."""

AFBITS = Table("afbits", "Afbit", ("category", "part", "feature"))
"""Afbits: rows of `afbits.csv`, and those that rules make."""


def property_of(column: str) -> URIRef:
    """The property that a column states: `length_min_m` states `afn:lengthMin`, in metres."""
    head, *rest = re.sub(r"_(m|kg)$", "", column).split("_")
    return URIRef(AFN + head + "".join(part.capitalize() for part in rest))
