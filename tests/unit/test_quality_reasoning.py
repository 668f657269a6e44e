from __future__ import annotations

from pathlib import Path

import pytest

from afkb.errors import KnowledgeError
from afkb.quality import gates
from afkb.quality.checked import Checked
from afkb.quality.explanation import smallest
from afkb.quality.gates import Reasoner, Task, run_gates
from afkb.quality.reasoner import is_consistent, java
from afkb.quality.reasoning import check_reasoning
from quality_samples import broken, told

needs_java = pytest.mark.skipif(java() is None, reason="no Java")
HOME = """@prefix : <https://w3id.org/afkb/afnet#> .
@prefix owl: <http://www.w3.org/2002/07/owl#> .
@prefix rdfs: <http://www.w3.org/2000/01/rdf-schema#> .
:Thing a owl:Class .
:Grasp a owl:Class ; owl:disjointWith :Thing .
:of a owl:ObjectProperty ; rdfs:domain :Grasp .
:Mug a :Thing, owl:NamedIndividual ; :fromRow "cups.csv, line 7" .
:fromRow a owl:AnnotationProperty .
:Clay a :Thing, owl:NamedIndividual .
"""


def reasoned(folder: Path, added: str) -> str:
    path = folder / "home.ttl"
    path.write_text(f"{HOME}{added}\n")
    return told(check_reasoning(Checked.of_files([path])))


@needs_java
def test_a_sound_ontology_is_consistent(tmp_path: Path) -> None:
    assert told(check_reasoning(broken(tmp_path, "", ""))) == ""


@needs_java
def test_a_class_that_can_have_no_instance_is_named(tmp_path: Path) -> None:
    found = reasoned(tmp_path, ":Odd a owl:Class ; rdfs:subClassOf :Thing, :Grasp .")
    assert found.startswith(
        f"{tmp_path}/home.ttl, line 10: Odd: no individual can be of this class"
    )
    assert found.count("\n") == 0


@needs_java
def test_a_class_that_individuals_empty_is_named(tmp_path: Path) -> None:
    nominal = "[ a owl:Class ; owl:oneOf ( :Clay ) ]"
    odd = f":Odd a owl:Class ; rdfs:subClassOf {nominal} ; owl:disjointWith :Thing ."
    assert ": Odd: no individual can be of this class" in reasoned(tmp_path, odd)


@needs_java
def test_a_contradiction_names_the_statements_that_clash(tmp_path: Path) -> None:
    found = reasoned(tmp_path, ":Mug :of :Clay .")
    assert "cups.csv, line 7: Mug: can't all be: " in found
    assert "Mug of Clay" in found
    assert "Mug type Thing" in found
    assert "Clay type" not in found


@needs_java
def test_axioms_that_clash_by_themselves_are_told(tmp_path: Path) -> None:
    found = reasoned(tmp_path, "owl:Thing rdfs:subClassOf :Thing, :Grasp .")
    assert "the axioms on classes and properties contradict each other" in found


def test_without_java_the_gate_is_not_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(gates, "java", lambda: None)
    broken(tmp_path, "", "")
    task = Task([tmp_path / "sample.ttl"], [], Path(__file__).parents[2] / "ontology")
    lines = [str(gate) for gate in run_gates(task, lambda: None)]
    assert any(line.startswith("reasoner: not run (no Java; install one") for line in lines)
    required = [str(gate) for gate in run_gates(task, lambda: None, reasoner=Reasoner.REQUIRED)]
    assert "reasoner: failed 1" in required


def test_hermit_needs_java(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", "")
    with pytest.raises(KnowledgeError, match="no Java; install one"):
        is_consistent([])


def test_the_smallest_bad_part_is_found() -> None:
    asked = []

    def is_bad(some: object) -> bool:
        asked.append(some)
        return {3, 500, 501} <= set(some)  # type: ignore[call-overload]

    assert smallest(range(1000), is_bad) == [3, 500, 501]
    assert len(asked) < 80
