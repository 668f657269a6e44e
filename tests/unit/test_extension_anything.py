"""Whatever a file holds, it is read or refused with its name; nothing else escapes."""

from __future__ import annotations

from pathlib import Path

from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from afkb.errors import KnowledgeError
from afkb.extensions import read_stack
from afkb.knowledge import bundled_ontology
from test_extension_reading import EVERYTHING

LINES = ("extension: home\n" + EVERYTHING).splitlines()
WORDS = ["", "~", "[]", "{}", "[1, 2]", "-3", "1e999", "Mug", "{a: b}", "[[1]]", "true", "|", "- x"]
quickly = settings(
    max_examples=40, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)


def read(path: Path) -> None:
    try:
        read_stack([bundled_ontology(), path])
    except KnowledgeError as error:
        assert all(path.name in line for line in str(error).splitlines())


@quickly
@given(st.text())
@example("extension: home\ncategories: {? [a]: b}\n")
@example("a: &x [*x]\n")
@example("[" * 5000)
def test_any_text(tmp_path: Path, text: str) -> None:
    path = tmp_path / "home.yaml"
    path.write_text(text, encoding="utf-8")
    read(path)


@quickly
@given(st.integers(0, len(LINES) - 1), st.sampled_from(WORDS), st.sampled_from(["drop", "set"]))
def test_any_slip_in_a_good_file(tmp_path: Path, at: int, word: str, how: str) -> None:
    changed = [] if how == "drop" else [f"{LINES[at].split(':')[0]}: {word}"]
    path = tmp_path / "home.yaml"
    path.write_text("\n".join([*LINES[:at], *changed, *LINES[at + 1 :]]), encoding="utf-8")
    read(path)


@quickly
@given(st.lists(st.lists(st.text(max_size=8), min_size=1, max_size=4), max_size=4))
def test_any_cells_in_a_table(tmp_path: Path, rows: list[list[str]]) -> None:
    path = tmp_path / "afbits.csv"
    lines = ["category,feature,strength", *(",".join(row) for row in rows)]
    path.write_text("\n".join(lines), encoding="utf-8")
    read(path)


@quickly
@given(st.binary(max_size=200), st.sampled_from(["owl", "ttl", "csv", "yaml"]))
def test_any_bytes(tmp_path: Path, content: bytes, ending: str) -> None:
    path = tmp_path / f"home.{ending}"
    path.write_bytes(content)
    read(path)
