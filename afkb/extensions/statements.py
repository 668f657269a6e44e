"""What a file states, as plain subject, property and values, with the line of each."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from rdflib import Graph, URIRef

from afkb.extensions.problems import Problems
from afkb.extensions.sheet import Sheet
from afkb.extensions.terms import WORD_OF, Term, Terms, scale_limits
from afkb.ontology.names import AFN, RDF_TYPE, SKOS, Names, fragment, property_iri
from afkb.ontology.statements import add_individual

KEYED = {
    "Afbit": ("ofCategory", "ofPart", "ofFeature"),
    "RoomEvidence": ("ofRoom", "ofEvidenceClass"),
    "Trapezoid": ("ofFeature", "parameterName"),
}
"""Class to the properties whose values may be met together once only."""


@dataclass(slots=True)
class Statements:
    """Subject to property to values, all as text; and the place of each, as far as it is known.

    `unnamed`: the classes of this ontology whose individuals have no IRI; nobody reads those.
    """

    values: dict[str, dict[str, list[str]]] = field(default_factory=dict)
    places: dict[tuple[str, str], str] = field(default_factory=dict)
    file: str = ""
    unnamed: list[str] = field(default_factory=list)

    def add(self, subject: str, prop: str, value: str) -> None:
        """Add one statement."""
        values = self.values.setdefault(subject, {}).setdefault(prop, [])
        if value not in values:
            values.append(value)

    def of_type(self, *class_names: str) -> list[str]:
        """The individuals of these classes of the ontology, in the order of the file."""
        wanted = {AFN + name for name in class_names}
        return [s for s, p in self.values.items() if wanted & set(p.get(RDF_TYPE, ()))]

    def many(self, subject: str, prop: str) -> list[str]:
        """The values of a property of the ontology, or of one by its IRI."""
        return self.values.get(subject, {}).get(property_iri(prop), [])

    def one(self, subject: str, prop: str) -> str:
        """The first value, or an empty string."""
        return next(iter(self.many(subject, prop)), "")

    def place(self, subject: str, prop: str = "") -> str:
        """File and line where a subject's property is stated, or the subject itself."""
        found = self.places.get((subject, property_iri(prop) if prop else ""))
        return found or self.places.get((subject, ""), self.file)

    def keyed(self) -> Iterator[tuple[tuple[str, ...], str]]:
        """Key and subject of each statement that has a key."""
        for name, props in KEYED.items():
            for subject in self.of_type(name):
                parts = [fragment(self.one(subject, prop)) for prop in props]
                yield tuple(part for part in parts if part), subject

    def terms(self) -> Iterator[Term]:
        """The terms that are defined here."""
        for class_name, word in WORD_OF.items():
            for subject in self.of_type(class_name):
                if defines(self, subject):
                    yield Term(
                        fragment(subject),
                        subject,
                        word,
                        self.place(subject),
                        broader=fragment(self.one(subject, SKOS + "broader")),
                        scale=fragment(self.one(subject, "scale")),
                        kind=class_name.removesuffix("Affordance").lower(),
                    )


def terms_of(statements: Statements) -> Terms:
    """The terms that a file defines, its scales, and the keys of its statements."""
    terms = Terms()
    for term in statements.terms():
        terms.add(term)
        if term.word == "scale":
            ends = [statements.one(term.iri, p) for p in ("extentMin", "extentMax")]
            terms.scales.append(scale_limits(term.name, *ends))
        if term.word == "measure":
            name = statements.one(term.iri, "measureName")
            terms.measures[name] = tuple(statements.many(term.iri, "measureOf"))
    for key, subject in statements.keyed():
        terms.stated.setdefault(key, statements.place(subject))
    return terms


def defines(statements: Statements, subject: str) -> bool:
    """Whether more is said of a subject than that it is an individual of a class.

    Editors repeat the type of another file's individual; that defines nothing.
    """
    return any(prop != RDF_TYPE for prop in statements.values.get(subject, {}))


def of_sheet(sheet: Sheet, names: Names, problems: Problems) -> Statements:
    """What the rows of a sheet state; rows that can't be read go to `problems`."""
    graph = Graph()
    found = Statements(file=sheet.file.name)
    for entry in sheet.entries:
        with problems.noting():
            subject = add_individual(graph, entry.table, entry.row, names)
            found.places[str(subject), ""] = entry.row.place
            for column in entry.lines:
                for prop, _ in entry.table.cell_states(entry.row, column, names):
                    found.places[str(subject), str(prop)] = entry.place(column)
            _copy(graph, [subject], found)
    return found


def _copy(graph: Graph, subjects: Iterable[URIRef], into: Statements) -> None:
    for subject in subjects:
        for prop, value in graph.predicate_objects(subject):
            into.add(str(subject), str(prop), str(value))
