"""The worked extension: its README's commands run, and find what the extension added."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from running import ROOT, run_afkb, run_document

pytestmark = pytest.mark.xdist_group("examples")
EXTENSION = str(ROOT / "examples" / "my_home" / "my-home.yaml")
BENCHES_XY = [(3.9, 3.2), (3.2, 0.7)]
"""In the world file; the map's origin is the first base pose (0.8, 1.8)."""


@pytest.fixture(scope="session")
def said(tmp_path_factory: pytest.TempPathFactory) -> dict[str, object]:
    """The folder in which the README's commands ran, and what each block of them printed."""
    folder = tmp_path_factory.mktemp("my-home")
    printed = run_document("examples/my_home/README.md", folder)
    return {"folder": folder, "printed": printed}


def test_the_category_is_one_that_no_table_has() -> None:
    tables = ROOT / "ontology" / "tables"
    for path in tables.rglob("*.csv"):
        assert "PottingBench" not in path.read_text(encoding="utf-8"), path


def test_rules_made_afbits_for_it(said: dict[str, object]) -> None:
    checked, _, _ = said["printed"]  # type: ignore[misc]
    assert "rule FlatTopSupports" in checked


def test_both_benches_are_found_where_they_stand(said: dict[str, object]) -> None:
    query = (ROOT / "examples" / "my_home" / "potting-benches.rq").read_text(encoding="utf-8")
    rows = _answers(said, query)
    found = sorted((float(r["x"]["value"]), float(r["y"]["value"])) for r in rows)
    stand = sorted((x - 0.8, y - 1.8) for x, y in BENCHES_XY)
    assert len(found) == 2
    for at, is_at in zip(stand, found, strict=True):
        assert is_at == pytest.approx(at, abs=0.15)


def test_whoever_asks_for_furniture_gets_them(said: dict[str, object]) -> None:
    _, _, furniture = said["printed"]  # type: ignore[misc]
    assert furniture.count("potting bench") == 2


def test_subclass_queries_find_them(said: dict[str, object]) -> None:
    asked = (
        "PREFIX home: <https://example.org/my-home#> SELECT ?c WHERE { "
        "home:PottingBench afn:entityClass ?c . ?c rdfs:subClassOf+ afn:Entity }"
    )
    (row,) = _answers(said, asked)
    assert row["c"]["value"] == "https://example.org/my-home#PottingBenchEntity"


def _answers(said: dict[str, object], query: str) -> list[dict[str, dict[str, str]]]:
    folder = said["folder"]
    assert isinstance(folder, Path)
    options = ["--ontology", EXTENSION, "--format", "json"]
    out = run_afkb("query", "garden-room", query, *options, cwd=folder)
    return json.loads(out)["results"]["bindings"]  # type: ignore[no-any-return]
