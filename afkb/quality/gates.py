"""Runs the quality gates, one after another."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path

from afkb.errors import KnowledgeError
from afkb.ontology.rdf_files import RDF_FORMATS
from afkb.quality.checked import Checked
from afkb.quality.findings import Finding, Gate, findings_of_error
from afkb.quality.pitfalls import PITFALLS, check_pitfalls
from afkb.quality.questions import check_questions, read_questions, store_of
from afkb.quality.reasoner import NO_JAVA, java
from afkb.quality.reasoning import check_reasoning
from afkb.quality.shape_check import check_shapes, read_shapes


@dataclass(frozen=True, slots=True)
class Task:
    """What to check: `files` beside `context`; without context they are the ontology itself.

    `folder`: holds shapes, questions and alignments.
    """

    files: Sequence[Path]
    context: Sequence[Path]
    folder: Path


class Reasoner(StrEnum):
    """Whether the reasoner, which needs Java and most of the time, is run."""

    WHERE_FOUND = "where there is Java"
    REQUIRED = "always"
    LEFT_OUT = "not asked for"


def run_gates(
    task: Task, read: Callable[[], object], reasoner: Reasoner = Reasoner.WHERE_FOUND
) -> Iterator[Gate]:
    """Each gate as it is done: reading, shapes, pitfalls, reasoner, questions.

    `read`: reads everything as every command does, and raises `KnowledgeError`. The questions
    are asked of the ontology itself, not of extensions.
    """
    yield _gate("reading", lambda: _nothing(read()))
    try:
        checked = Checked.of_files(task.files, task.context)
    except KnowledgeError as error:
        yield Gate("shapes, pitfalls, reasoner", findings_of_error(error))
        return
    yield from gates_of(checked, task, reasoner)


def gates_of(
    checked: Checked, task: Task, reasoner: Reasoner = Reasoner.WHERE_FOUND
) -> Iterator[Gate]:
    """The gates that look at the statements: shapes, pitfalls, reasoner, questions."""
    shapes = read_shapes(task.folder / "shapes")
    terms = f"{len(checked.own)} terms"
    yield _gate("shapes", lambda: check_shapes(checked, shapes), terms)
    yield _gate("pitfalls", lambda: check_pitfalls(checked), f"{len(PITFALLS)} kinds")
    yield _reasoner("reasoner", checked, reasoner)
    if task.context:
        return
    yield _questions("questions", task.folder / "questions", checked)
    yield from _aligned(task, reasoner)


def _gate(name: str, check: Callable[[], list[Finding]], note: str = "") -> Gate:
    try:
        return Gate(name, check(), note)
    except KnowledgeError as error:
        return Gate(name, findings_of_error(error))


def _nothing(_: object) -> list[Finding]:
    return []


def _aligned(task: Task, reasoner: Reasoner) -> Iterator[Gate]:
    """The reasoner, and the questions that need them, over the ontology with all alignments."""
    folder = task.folder / "alignments"
    alignments = sorted(path for path in folder.glob("*") if path.suffix in RDF_FORMATS)
    if not alignments:
        return
    try:
        checked = Checked.of_files([*task.files, *alignments])
    except KnowledgeError as error:
        yield Gate("reasoner, aligned", findings_of_error(error))
        return
    note = f"{len(alignments)} alignments"
    yield _reasoner("reasoner, aligned", checked, reasoner, note)
    yield _questions("questions, aligned", task.folder / "questions" / "aligned", checked)


def _questions(name: str, folder: Path, checked: Checked) -> Gate:
    try:
        questions = read_questions(folder)
    except KnowledgeError as error:
        return Gate(name, findings_of_error(error))
    note = f"{len(questions)} asked"
    return _gate(name, lambda: check_questions(store_of(checked.graph), questions), note)


def _reasoner(name: str, checked: Checked, reasoner: Reasoner, note: str = "") -> Gate:
    if reasoner is Reasoner.LEFT_OUT:
        return Gate(name, [], str(reasoner), was_run=False)
    if java() is None:
        require = reasoner is Reasoner.REQUIRED
        missing = [Finding("", "", NO_JAVA, "")] if require else []
        return Gate(name, missing, "" if require else NO_JAVA, was_run=require)
    return _gate(name, lambda: check_reasoning(checked), note or "HermiT")
