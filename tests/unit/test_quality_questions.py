from __future__ import annotations

from pathlib import Path

import pytest

from afkb.errors import KnowledgeError
from afkb.quality.questions import check_questions, read_questions, store_of
from quality_samples import broken, told

SELECT = "# Which scales are there?\nSELECT ?scale ?to WHERE { ?scale a afn:Scale . " \
    "OPTIONAL { ?scale afn:extentMax ?to } }"  # fmt: skip


def asked(folder: Path, sparql: str, answers: str) -> str:
    (folder / "scales.rq").write_text(sparql)
    (folder / "scales.csv").write_text(answers)
    store = store_of(broken(folder, "", "").graph)
    return told(check_questions(store, read_questions(folder))).replace(f"{folder}/", "")


def test_the_expected_answers_pass_in_any_order_and_with_numbers_as_numbers(tmp_path: Path) -> None:
    assert asked(tmp_path, SELECT, "scale,to\nSmall,0.350\nLarge,\n") == ""
    assert asked(tmp_path, "ASK { afn:Mug a afn:ObjectCategory }", "answer\nyes\n") == ""


def test_missing_and_unexpected_answers_are_told(tmp_path: Path) -> None:
    assert asked(tmp_path, SELECT, "scale,to\nLarge,\nSmall,0.4\n").splitlines() == [
        "scales.csv, line 3: scales: expected and not found: Small, 0.4; "
        "mend the tables, or say why it was wrong to expect it",
        "scales.rq: scales: found and not expected: Small, 0.35; mend the tables or the query",
    ]


def test_a_row_counts_as_often_as_it_is_there(tmp_path: Path) -> None:
    found = asked(tmp_path, SELECT, "scale,to\nLarge,\nLarge,\nSmall,0.35\n")
    assert found.startswith("scales.csv, line 3: scales: expected and not found: Large, ;")


@pytest.mark.parametrize(
    ("sparql", "answers", "message"),
    [
        ("SELECT ?x WHERE {", "x\n", "scales.rq: scales: can't be asked: "),
        ("CONSTRUCT WHERE { ?s ?p ?o }", "s\n", "neither SELECT nor ASK; mend the query"),
        (SELECT, "scale\nSmall\n", "scales.csv, line 1: scales: the columns are scale, to, not"),
    ],
)
def test_a_question_that_does_not_fit_is_told(
    tmp_path: Path, sparql: str, answers: str, message: str
) -> None:
    assert message in asked(tmp_path, sparql, answers)


def test_a_question_without_answers_is_refused(tmp_path: Path) -> None:
    (tmp_path / "scales.rq").write_text(SELECT)
    with pytest.raises(KnowledgeError, match=r"scales\.csv: missing; write the answers by hand"):
        read_questions(tmp_path)


def test_every_question_of_the_ontology_says_itself_in_words() -> None:
    for question in read_questions(Path(__file__).parents[2] / "ontology" / "questions"):
        assert question.sparql.startswith("# "), question.file
