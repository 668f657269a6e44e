"""The statement of the ontology behind a figure of the network: who says so, and where."""

from __future__ import annotations

from dataclasses import dataclass

from afkb.errors import KnowledgeError
from afkb.knowledge import SOMETHING_ELSE, AfNet
from afkb.knowledge.model import Category, Statement
from afkb.ontology.names import fragment


@dataclass(frozen=True, slots=True)
class Source:
    """A statement: its `name`, what it `says`, its `status`, its `source`, and file and line."""

    name: str
    says: str
    status: str
    source: str
    place: str

    @property
    def line(self) -> str:
        """All of it in one line."""
        told = f"{self.says} ({self.status or 'no status'}; {self.source or 'no source'})"
        return f"{told}, {self.place}"


def of_statement(statement: Statement, says: str) -> Source:
    """The source of one of the knowledge base's items."""
    return Source(statement.name, says, statement.status, statement.source, statement.place)


def of_name(kb: AfNet, name: str, says: str) -> Source | None:
    """The source of a statement that is no item of its own, as a parameter; None if unknown."""
    try:
        facts = {fragment(p): v for p, v in kb.statements_about(name).items()}
    except KnowledgeError:
        return None
    status, source, row = (
        next(iter(facts.get(p, [])), "") for p in ("status", "source", "fromRow")
    )
    return Source(name, says, status, source, row)


def of_prior(kb: AfNet, category: str) -> Source:
    """Behind the prior of a category: how many of it a home has."""
    stated = kb.categories[category]
    return of_statement(stated, f"a home has {stated.expected_number:g} of {category}")


def of_feature(kb: AfNet, category: str, feature: str) -> Source | None:
    """Behind P(feature is reported | category): a rate, an afbit, an inherited one, or the leak."""
    if category == SOMETHING_ELSE:
        says = "of something else nothing is known: the mean of all categories, spread"
        return of_name(kb, "UnknownBreadth", says)
    for name in kb.kinds_of(category):
        kind = kb.categories.get(name)
        if kind is None:
            continue
        if feature in kind.report_rates:
            says = f"{name}: {feature} is reported at a rate of {kind.report_rates[feature]:g}"
            return of_name(kb, f"{name}.{feature}.Rate", says)
        if feature in kind.afbits:
            return _of_afbit(kb, kind, feature)
    leak = kb.parameters["AfbitLeak"]
    says = f"{category} has no afbit of {feature}: a detector reports it all the same at {leak:g}"
    return of_name(kb, "AfbitLeak", says)


def _of_afbit(kb: AfNet, kind: Category, feature: str) -> Source | None:
    stated = [
        a
        for a in kb.afbits
        if (a.category, a.feature, a.strength) == (kind.name, feature, kind.afbits[feature])
    ]
    whole_first = sorted(stated, key=lambda a: a.part is not None)
    return of_statement(whole_first[0], whole_first[0].notation) if stated else None


def of_measure(kb: AfNet, category: str, measure: str) -> Source:
    """Behind P(a measure | category): the category's typical range of it, m."""
    stated = kb.categories[category]
    ranges = {
        "Length": stated.length_m,
        "Width": stated.width_m,
        "Height": stated.height_m,
        "TopHeight": stated.top_height_m,
    }
    found = ranges.get(measure)
    typical = f"{found[0]:g} to {found[1]:g} m" if found else "anywhere"
    return of_statement(stated, f"{measure} of {category}: {typical}")


def of_room_prior(kb: AfNet, room: str) -> Source:
    """Behind the prior of a room category: how many such rooms a home has."""
    stated = kb.rooms[room]
    return of_statement(stated, f"a home has {stated.expected_number:g} of {room}")


def of_count(kb: AfNet, room: str, evidence_class: str) -> Source | None:
    """Behind P(a count | room category): how many such things the room holds on average."""
    mean = kb.rooms[room].expected_counts.get(evidence_class)
    if mean is None:
        says = f"{room} states no count of {evidence_class}: the mean of the rooms that do"
        return of_name(kb, evidence_class, says)
    says = f"{room} holds {mean:g} of {evidence_class}"
    return of_name(kb, f"{room}.{evidence_class}", says)
