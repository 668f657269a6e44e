"""Asks the competency questions of the ontology as it is delivered."""

from __future__ import annotations

from pathlib import Path

import pytest
from pyoxigraph import RdfFormat, Store

from afkb.quality.questions import Question, check_questions, read_questions

ONTOLOGY = Path(__file__).parents[2] / "ontology"
QUESTIONS = ONTOLOGY / "questions"
ALIGNED = QUESTIONS / "aligned"
LEAST = 40
"""So many questions at least, besides those that need the alignments."""


def name_of(question: Question) -> str:
    return question.file.stem


def loaded(*files: Path) -> Store:
    store = Store()
    for path in (ONTOLOGY / "afnet.owl", *files):
        form = RdfFormat.TURTLE if path.suffix == ".ttl" else RdfFormat.RDF_XML
        store.bulk_load(path.read_bytes(), form)
    return store


@pytest.fixture(scope="module")
def store() -> Store:
    return loaded()


@pytest.fixture(scope="module")
def aligned() -> Store:
    return loaded(*sorted((ONTOLOGY / "alignments").glob("*.ttl")))


@pytest.mark.parametrize("question", read_questions(QUESTIONS), ids=name_of)
def test_the_ontology_answers_as_its_tables_say(store: Store, question: Question) -> None:
    assert [str(finding) for finding in check_questions(store, [question])] == []


@pytest.mark.parametrize("question", read_questions(ALIGNED), ids=name_of)
def test_with_its_alignments_it_answers_what_others_call_things(
    aligned: Store, question: Question
) -> None:
    assert [str(finding) for finding in check_questions(aligned, [question])] == []


def test_there_are_enough_questions() -> None:
    assert len(read_questions(QUESTIONS)) >= LEAST


@pytest.mark.parametrize("folder", [QUESTIONS, ALIGNED], ids=lambda folder: folder.name)
def test_each_question_has_an_answer_and_each_answer_a_question(folder: Path) -> None:
    asked = {path.stem for path in folder.glob("*.rq")}
    answered = {path.stem for path in folder.glob("*.csv")}
    assert asked == answered
    empty = [name_of(q) for q in read_questions(folder) if not q.rows]
    assert empty == [], "nothing is expected: write the answers down, or ask with ASK"


@pytest.mark.parametrize("folder", [QUESTIONS, ALIGNED], ids=lambda folder: folder.name)
def test_each_question_asks_in_plain_words_first(folder: Path) -> None:
    for question in read_questions(folder):
        first = question.sparql.splitlines()[0]
        assert first.startswith("# ") and "?" in first, question.file


def test_no_question_is_asked_twice() -> None:
    words = [q.sparql.splitlines()[0] for q in read_questions(QUESTIONS) + read_questions(ALIGNED)]
    assert len(words) == len(set(words))
