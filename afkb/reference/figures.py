"""The counted figures that the ontology states, by the things and rooms that they are about."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import TypeVar

from afkb.csv_rows import Row
from afkb.extensions import extension_homes
from afkb.knowledge import AfNet
from afkb.knowledge.facts import Facts
from afkb.ontology.counted import counted_rows
from afkb.ontology.names import DCTERMS, fragment

T = TypeVar("T")
CLASSES = ("ObjectInRoom", "ObjectWithObject", "ObjectOnSupport")


@dataclass(frozen=True, slots=True)
class StatedFigure:
    """P(`category`, given the other), smoothed, with the counts behind it.

    `other`: the room, the thing in the same room, or the thing that stands on the category.
    `mean_number`: of things in such a room, None for other figures.
    """

    category: str
    other: str
    probability: float
    successes: float
    trials: float
    buildings: int
    mean_number: float | None
    source: str


@dataclass(frozen=True, slots=True)
class StatedFigures:
    """The figures, likeliest first: those of a category, and those given the other."""

    of: Mapping[str, list[StatedFigure]]
    given: Mapping[str, list[StatedFigure]]


@dataclass(frozen=True, slots=True)
class StatedCount:
    """How many things of an evidence class a room of a category holds on average."""

    evidence_class: str
    count: float
    status: str
    source: str
    place: str


def read_counts(facts: Facts) -> Mapping[str, list[StatedCount]]:
    """What rooms hold of the evidence classes, by room, the most first."""
    counts = (
        (fragment(facts.text(iri, "ofRoom")), _count(facts, iri))
        for iri in facts.of_type("RoomEvidence")
    )
    ordered = sorted(counts, key=lambda pair: (-pair[1].count, pair[1].evidence_class))
    return _grouped(ordered)


def _count(facts: Facts, iri: str) -> StatedCount:
    return StatedCount(
        evidence_class=fragment(facts.text(iri, "ofEvidenceClass")),
        count=facts.number(iri, "expectedCount"),
        status=facts.text(iri, "status", default="proposed"),
        source=facts.text(iri, DCTERMS + "source", default=""),
        place=facts.text(iri, "fromRow", default=facts.file_of[iri].name),
    )


def figures_of(base: AfNet, facts: Facts) -> dict[str, StatedFigures]:
    """The figures by class: `ObjectInRoom`, `ObjectWithObject`, `ObjectOnSupport`.

    As the ontology states them; where extensions bring homes, as they are with those counted in.
    """
    if any(extension_homes(file) for file in base.files[1:]):
        rows = [(table.class_name, row) for table, row in counted_rows(base.figures)]
        return {c: _sorted(_of_row(row) for name, row in rows if name == c) for c in CLASSES}
    return {c: _sorted(_of_facts(facts, iri) for iri in facts.of_type(c)) for c in CLASSES}


def _sorted(figures: Iterable[StatedFigure]) -> StatedFigures:
    ordered = sorted(figures, key=lambda f: (-f.probability, f.category, f.other))
    return StatedFigures(
        _grouped((f.category, f) for f in ordered), _grouped((f.other, f) for f in ordered)
    )


def _grouped(pairs: Iterable[tuple[str, T]]) -> Mapping[str, list[T]]:
    found: dict[str, list[T]] = defaultdict(list)
    for key, item in pairs:
        found[key].append(item)
    return dict(found)


def _of_facts(facts: Facts, iri: str) -> StatedFigure:
    other = facts.one(iri, "ofRoom") or facts.text(iri, "givenCategory")
    mean = facts.one(iri, "meanNumber")
    return StatedFigure(
        category=fragment(facts.text(iri, "ofCategory")),
        other=fragment(other),
        probability=facts.probability(iri, "probability"),
        successes=facts.number(iri, "successes", default=0.0),
        trials=facts.number(iri, "trials", default=0.0),
        buildings=int(facts.number(iri, "buildings", default=0.0)),
        mean_number=None if mean is None else float(mean),
        source=_counted_in(facts.text(iri, DCTERMS + "source", default="")),
    )


def _of_row(row: Row) -> StatedFigure:
    return StatedFigure(
        category=row["object"],
        other=row.get("room") or row["given"],
        probability=row.number("probability"),
        successes=row.number("successes"),
        trials=row.number("trials"),
        buildings=int(row.number("buildings")),
        mean_number=row.number("mean_number") if row.get("mean_number") else None,
        source=_counted_in(row["source"]),
    )


def _counted_in(source: str) -> str:
    return source.removeprefix("counted in ").partition(";")[0]
