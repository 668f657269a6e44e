"""Checks what a file states against the terms that there are, whatever it was written in."""

from __future__ import annotations

from collections.abc import Iterator

from afkb.extensions.change_check import check_changes
from afkb.extensions.measure_check import check_measures
from afkb.extensions.number_check import check_numbers
from afkb.extensions.problems import Problems, nearest
from afkb.extensions.statements import Statements, terms_of
from afkb.extensions.terms import Term, Terms
from afkb.ontology.names import AFN, SKOS, fragment

_BROADER = SKOS + "broader"
_REFERS: dict[str, tuple[str, ...]] = {
    "ofCategory": ("category",),
    "ofFeature": ("feature",),
    "ofPart": ("part",),
    "ofRoom": ("room",),
    "ofEvidenceClass": ("evidence class",),
    "scale": ("scale",),
    "predictedScale": ("scale",),
    "shape": ("shape",),
    "madeOf": ("material",),
    "hasTrait": ("trait",),
    "pose": ("pose",),
    "evidence": ("feature",),
    "predicted": ("feature",),
    "evidenceCategory": ("category",),
    "predictedCategory": ("category",),
    "evidenceClass": ("evidence class",),
    "predictedClass": ("evidence class",),
}
"""Property to the words for what it may name."""
_NEEDED = {
    "ObjectCategory": (
        "scale", "lengthMin", "lengthMax", "widthMin", "widthMax", "heightMin", "heightMax",
        "matchingWeight", "expectedNumber",
    ),
    "Afbit": ("ofCategory", "ofFeature", "strength"),
    "Dual": ("evidence", "predicted", "relation", "strength", "predictedScale"),
    "CoOccurrence": ("ofFeature", "strength", "predictedScale"),
    "EvidenceClass": ("ofFeature",),
    "RoomCategory": ("expectedNumber",),
    "RoomEvidence": ("ofRoom", "ofEvidenceClass", "expectedCount"),
}  # fmt: skip
KINDS_OF_THINGS = ("category", "group")


def check_statements(statements: Statements, earlier: Terms, problems: Problems) -> Terms:
    """Note everything that is wrong in a file; returns the terms with the file's own among them.

    `earlier`: the terms of the ontology and of the files that are read before this one.
    """
    known, of_file = earlier.copy(), terms_of(statements)
    own = list(statements.terms())
    for term in own:
        known.add(term)
    known.scales += of_file.scales
    known.measures |= of_file.measures
    twice = _check_names(own, earlier, statements, problems)
    _check_keys(statements, known, problems)
    check_changes(statements, earlier, problems)
    for class_name, needed in _NEEDED.items():
        for subject in statements.of_type(class_name):
            _check_needed(subject, needed, statements, problems)
    for subject in statements.values:
        _check_references(subject, statements, known, twice, problems)
    check_numbers(statements, problems)
    check_measures(statements, known, problems)
    _check_pairs(statements, problems)
    _check_cycles(own, known, statements, problems)
    return known


def _check_names(
    own: list[Term], earlier: Terms, statements: Statements, problems: Problems
) -> set[str]:
    """Note names that are taken, and return them."""
    taken = {term.name: term for term in earlier.all()}
    twice = set()
    for term in own:
        first = taken.setdefault(term.name, term)
        if first is term or (first.iri == term.iri and not _says_more(statements, term.iri)):
            continue
        mend = "rename one, or leave this one out"
        if term.word == "category" and not first.place.startswith(statements.file):
            mend = "rename this one, or add afbits to that one: `afbits:`"
        problems.add(
            term.place, f"{term.name} is stated a second time, after {first.place}; {mend}"
        )
        twice.add(term.name)
    return twice


def _says_more(statements: Statements, iri: str) -> bool:
    return any(prop.startswith(AFN) for prop in statements.values[iri])


def _check_keys(statements: Statements, known: Terms, problems: Problems) -> None:
    for key, subject in statements.keyed():
        place = statements.place(subject)
        if key in known.stated:
            said = " > ".join(("/".join(key[:-1]), key[-1]))
            first = known.stated[key]
            problems.add(place, f"{said} is stated a second time, after {first}; keep one")
        known.stated.setdefault(key, place)


def _check_needed(
    subject: str, needed: tuple[str, ...], statements: Statements, problems: Problems
) -> None:
    for prop in needed:
        if not statements.many(subject, prop) and any(
            p.startswith(AFN) for p in statements.values[subject]
        ):
            problems.add(
                statements.place(subject), f"{fragment(subject)}: {prop} is missing; add it"
            )


def _check_references(
    subject: str, statements: Statements, known: Terms, twice: set[str], problems: Problems
) -> None:
    for prop, words, name, iri in _references(subject, statements, known):
        term = known.get(name, *words)
        if name not in twice and (term is None or term.iri != iri):
            problems.add(
                statements.place(subject, prop), _unknown(name, words, term, statements, known)
            )


def _unknown(
    name: str, words: tuple[str, ...], term: Term | None, statements: Statements, known: Terms
) -> str:
    """What is wrong with a name that no term of those kinds has, and the mend."""
    if term is not None:
        return f"{words[0]} {name} is not in that namespace; write <{term.iri}>"
    mend = nearest(name, known.names(*words))
    other = next((t.word for t in known.all() if t.name == name), "")
    if other:
        mend = mend if f"did you mean {name}" in mend else f"name a {words[0]}"
        return f"{name} is a {other}, no {words[0]}; {mend}"
    return f"{words[0]} {name} is not in the ontology; {mend}"


def _references(
    subject: str, statements: Statements, known: Terms
) -> Iterator[tuple[str, tuple[str, ...], str, str]]:
    for prop, words in _REFERS.items():
        for iri in statements.many(subject, prop):
            yield prop, words, fragment(iri), iri
    for iri in statements.many(subject, _BROADER):
        words = KINDS_OF_THINGS
        if known.get(fragment(subject), "feature"):
            words = ("feature",)
        yield _BROADER, words, fragment(iri), iri


def _check_pairs(statements: Statements, problems: Problems) -> None:
    for subject in statements.of_type("CoOccurrence"):
        classes = all(statements.many(subject, p) for p in ("evidenceClass", "predictedClass"))
        things = all(statements.many(subject, p) for p in ("evidenceCategory", "predictedCategory"))
        if not classes and not things:
            problems.add(
                statements.place(subject),
                f"{fragment(subject)} names neither two evidence classes nor two categories; "
                "name two of a kind",
            )


def _check_cycles(
    own: list[Term], known: Terms, statements: Statements, problems: Problems
) -> None:
    told: set[str] = set()
    for term in own:
        words = ("feature",) if term.word == "feature" else KINDS_OF_THINGS
        chain = [term.name]
        while (at := known.get(chain[-1], *words)) and at.broader and at.broader not in chain:
            chain.append(at.broader)
        closes = at.broader if at else ""
        if closes == term.name and term.name not in told:
            told |= set(chain)
            way = " > ".join([*chain, closes])
            problems.add(
                statements.place(term.iri, _BROADER),
                f"{term.name} is broader than itself: {way}; change one `broader` of these",
            )
