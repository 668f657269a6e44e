"""Asks the competency questions of `ontology/questions/` and compares the answers."""

from __future__ import annotations

import csv
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from pyoxigraph import QueryBoolean, QuerySolutions, RdfFormat, Store
from rdflib import Graph

from afkb.errors import KnowledgeError
from afkb.quality.findings import Finding
from afkb.store.vocabulary import PREFIXES, local_name

Answer = tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Question:
    """A question as SPARQL, and the answers that were written down beside it.

    `expected`: the file of answers; its rows, each with its line.
    """

    file: Path
    sparql: str
    columns: Answer
    rows: tuple[tuple[int, Answer], ...]

    @property
    def expected(self) -> Path:
        """The file of answers."""
        return self.file.with_suffix(".csv")


def read_questions(folder: Path) -> list[Question]:
    """The questions of a folder by file name; `KnowledgeError` for one without answers."""
    return [_question(file) for file in sorted(folder.glob("*.rq"))]


def _question(file: Path) -> Question:
    answers = file.with_suffix(".csv")
    if not answers.is_file():
        raise KnowledgeError(f"{answers}: missing; write the answers by hand before you ask")
    with answers.open(encoding="utf-8", newline="") as stream:
        reader = csv.reader(stream)
        columns = tuple(next(reader, ()))
        rows = tuple((reader.line_num, tuple(map(_cell, row))) for row in reader if row)
    return Question(file, file.read_text(encoding="utf-8"), columns, rows)


def store_of(graph: Graph) -> Store:
    """The graph where it is quick to ask."""
    store = Store()
    text = graph.serialize(format="nt", encoding="utf-8")
    store.bulk_load(text, RdfFormat.N_TRIPLES)
    return store


def check_questions(store: Store, questions: list[Question]) -> list[Finding]:
    """Answers that are missing, and those that nobody expected."""
    return [finding for question in questions for finding in _check(store, question)]


def _check(store: Store, question: Question) -> Iterator[Finding]:
    name = question.file.stem
    try:
        columns, found = _ask(store, question.sparql)
    except (SyntaxError, ValueError, OSError) as error:
        yield Finding(str(question.file), name, f"can't be asked: {error}", "mend the query")
        return
    if columns != question.columns:
        what = f"the columns are {', '.join(columns)}, not {', '.join(question.columns)}"
        yield Finding(f"{question.expected}, line 1", name, what, "let both be the same")
        return
    unexpected = Counter(found)
    for line, row in question.rows:
        if unexpected[row] > 0:
            unexpected[row] -= 1
        else:
            what = f"expected and not found: {', '.join(row)}"
            mend = "mend the tables, or say why it was wrong to expect it"
            yield Finding(f"{question.expected}, line {line}", name, what, mend)
    for row in sorted(unexpected.elements()):
        what = f"found and not expected: {', '.join(row)}"
        yield Finding(str(question.file), name, what, "mend the tables or the query")


def _ask(store: Store, sparql: str) -> tuple[Answer, list[Answer]]:
    answer = store.query(sparql, prefixes=PREFIXES)
    if isinstance(answer, QueryBoolean):
        return ("answer",), [("yes" if answer else "no",)]
    if not isinstance(answer, QuerySolutions):
        raise ValueError("neither SELECT nor ASK")
    columns = tuple(variable.value for variable in answer.variables)
    return columns, [tuple(_text(value) for value in row) for row in answer]


def _text(value: object) -> str:
    if value is None:
        return ""
    text = str(getattr(value, "value", value))
    return local_name(text) if type(value).__name__ == "NamedNode" else _cell(text)


def _cell(text: str) -> str:
    """A cell as it is compared: numbers by nine digits, so that 0.70 is 0.7."""
    try:
        return f"{float(text):.9g}"
    except ValueError:
        return text.strip()
