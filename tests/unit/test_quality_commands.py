from __future__ import annotations

import json
from pathlib import Path

import pytest
from rdflib import Graph
from typer.testing import CliRunner, Result

from afkb.cli.app import build_cli
from afkb.plugins.host import PluginHost
from afkb.quality.counts import count_statements
from afkb.quality.findings import Finding, Gate, findings_of_error
from ontology_samples import extension
from quality_samples import broken


@pytest.fixture(scope="module")
def run():  # type: ignore[no-untyped-def]
    cli = build_cli(PluginHost())

    def invoke(*arguments: str) -> Result:
        return CliRunner().invoke(cli, ["ontology", *arguments])

    return invoke


def test_an_extension_is_checked_gate_by_gate(run, tmp_path: Path) -> None:  # type: ignore[no-untyped-def]
    body = '<afn:Scale rdf:about="https://example.org/home#Tiny">' \
        "<afn:extentMax>-1.0</afn:extentMax></afn:Scale>"  # fmt: skip
    result = run("check", "--no-reasoner", str(extension(tmp_path, body)))
    assert result.exit_code == 1
    assert "shapes: failed" in result.stdout
    home = tmp_path / "home.owl"
    assert f"  {home}, line 6: Tiny: extentMax '-1.0' is no double; give the upper" in result.stdout
    assert f"  {home}, line 6: advice: Tiny: example is missing; " in result.stdout


def test_an_unreadable_file_is_told_with_its_line_as_text_or_json(run, tmp_path: Path) -> None:  # type: ignore[no-untyped-def]
    path = tmp_path / "home.ttl"
    path.write_text("@prefix : <urn:x#> .\n:a :b\n")
    result = run("check", str(path))
    assert result.exit_code == 1
    assert f"{path}, line 3: not readable as Turtle" in result.stdout
    gates = {gate["gate"]: gate for gate in json.loads(run("check", "--json", str(path)).stdout)}
    assert gates["reading"]["state"] == "failed"
    assert "line 3" in json.dumps(gates["reading"])


def test_every_statement_of_the_ontology_has_provenance(run) -> None:  # type: ignore[no-untyped-def]
    rows = {row["kind"]: row for row in json.loads(run("status", "--json").stdout)}
    assert rows["ObjectCategory"]["number"] >= 300
    statements = [
        row for kind, row in rows.items() if kind not in ("all", "Movability", "MovingHabit")
    ]
    assert all(row["with_provenance"] == row["number"] for row in statements)


def test_statements_are_counted_by_kind_and_status(tmp_path: Path) -> None:
    graph: Graph = broken(tmp_path, "", ':Mug.ContainAbility :status "stated" .').graph
    counts = {count.kind: count for count in count_statements(graph)}
    afbits = counts["structural afbits"]
    assert (afbits.number, afbits.with_two_sources, afbits.reviewed) == (1, 1, 0)
    assert counts["Scale"].by_status == {"proposed": 2}
    assert counts["all"].number == sum(c.number for k, c in counts.items() if k != "all")


def test_a_gate_fails_by_findings_that_are_more_than_advice() -> None:
    advice = Finding("home.owl", "Pot", "example is missing", "give one", advice=True)
    assert str(Gate("shapes", [advice])) == "shapes: passed (1 advised)"
    failed = Gate("shapes", [advice, Finding("home.owl", "Pot", "x", "y")], "2 terms")
    assert str(failed) == "shapes: failed 1 (2 terms; 1 advised)"
    assert str(Gate("reasoner", note="no Java", was_run=False)) == "reasoner: not run (no Java)"


def test_each_line_of_an_error_is_a_finding() -> None:
    found = findings_of_error(ValueError("a.yaml, line 2: no scale\nb.yaml, line 3: no mass"))
    assert [str(f) for f in found] == ["a.yaml, line 2: no scale", "b.yaml, line 3: no mass"]
