"""Checks that an extension adds to what is there, and changes none of it."""

from __future__ import annotations

from afkb.extensions.problems import Problems
from afkb.extensions.statements import Statements
from afkb.extensions.terms import WORD_OF, Term, Terms
from afkb.ontology.names import AFN, OWL, RDF_TYPE, RDFS, SKOS, fragment

_BROADER = SKOS + "broader"
_SUBCLASS = RDFS + "subClassOf"
_NOT_CHANGED = {_BROADER, OWL + "deprecated", OWL + "sameAs"}
"""Properties outside the ontology's namespace that change what is said of a term."""
_ADDED = {AFN + "madeOf", AFN + "hasTrait"}
"""Properties that may have more values than one."""


def check_changes(statements: Statements, earlier: Terms, problems: Problems) -> None:
    """Note statements about terms of the files before that would change these, and cycles."""
    known = {term.iri: term for term in earlier.all()}
    for subject, values in statements.values.items():
        term = known.get(subject)
        if term is not None:
            _check_word(term, statements, problems)
        if term is not None and not _states_again(term, statements):
            for prop in values:
                if (prop.startswith(AFN) and prop not in _ADDED) or prop in _NOT_CHANGED:
                    _note(term, prop, statements, problems)
        elif OWL + "Nothing" in values.get(_SUBCLASS, ()):
            problems.add(
                statements.place(subject, _SUBCLASS),
                f"{fragment(subject)} is a subclass of owl:Nothing: nothing could be one; "
                "leave that out",
            )
    _check_subclasses(statements, known, problems)
    for class_name in statements.unnamed:
        problems.add(
            statements.file,
            f"an individual of {class_name} has no IRI, so nobody could read it; give it one",
        )


def _states_again(term: Term, statements: Statements) -> bool:
    """Whether the whole term is stated once more, which is told as that."""
    return term.iri in {other.iri for other in statements.terms()}


def _check_word(term: Term, statements: Statements, problems: Problems) -> None:
    for class_name in statements.many(term.iri, RDF_TYPE):
        word = WORD_OF.get(class_name.removeprefix(AFN), term.word)
        if word != term.word:
            problems.add(
                statements.place(term.iri, RDF_TYPE),
                f"{term.name} is a {term.word} already ({term.place}), no {word}; "
                "give yours a name of its own",
            )


def _note(term: Term, prop: str, statements: Statements, problems: Problems) -> None:
    problems.add(
        statements.place(term.iri, prop),
        f"{term.name}: {fragment(prop)} is stated by {term.place}; an extension adds and changes "
        "nothing: leave this out",
    )


def _check_subclasses(statements: Statements, known: dict[str, Term], problems: Problems) -> None:
    """Note classes that are subclasses of themselves, by way of the categories' own."""
    above = {s: list(statements.many(s, _SUBCLASS)) for s in statements.values}
    if not any(above.values()):
        return
    for term in known.values():
        if term.broader and term.word in ("category", "group"):
            broader = next((t.iri for t in known.values() if t.name == term.broader), "")
            above.setdefault(f"{term.iri}Entity", []).append(f"{broader}Entity")
    for subject in statements.values:
        way = _way_back(subject, above)
        if way:
            shown = " > ".join(map(fragment, way))
            problems.add(
                statements.place(subject, _SUBCLASS),
                f"{fragment(subject)} is a subclass of itself: {shown}; take one step out",
            )


def _way_back(start: str, above: dict[str, list[str]]) -> list[str]:
    """The classes from one up to itself; empty where there is no such way."""
    paths = [[start]]
    seen: set[str] = set()
    while paths:
        path = paths.pop()
        for step in above.get(path[-1], ()):
            if step == start:
                return [*path, step]
            if step not in seen:
                seen.add(step)
                paths.append([*path, step])
    return []
