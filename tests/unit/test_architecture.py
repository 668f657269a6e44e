"""Imports go the way that ARCHITECTURE.md draws: no room imports one that stands on it."""

import ast
import re
from collections.abc import Iterator
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
_ROW = re.compile(r"^\| `afkb/(\w+)` \|[^|]*\|([^|]*)\|$", re.MULTILINE)
MAY_IMPORT = {
    room: set(re.findall(r"`(\w+)`", named))
    for room, named in _ROW.findall((ROOT / "ARCHITECTURE.md").read_text(encoding="utf-8"))
}
"""Room to the rooms that it may import, as the page's table has it."""
FOR_ALL = {"errors", "csv_rows", "__init__"}


def module_of(file: Path) -> str:
    return ".".join(file.relative_to(ROOT).with_suffix("").parts)


FILES = {module_of(file): file for file in sorted((ROOT / "afkb").rglob("*.py"))}


def imported(nodes: Iterator[ast.AST] | list[ast.stmt]) -> Iterator[str]:
    """The modules of the package that import statements name, each as a file."""
    for node in nodes:
        if isinstance(node, ast.ImportFrom) and (node.module or "").split(".")[0] == "afkb":
            names = [f"{node.module}.{alias.name}" for alias in node.names]
            yield from (name if name in FILES else file_of(str(node.module)) for name in names)


def file_of(module: str) -> str:
    return module if module in FILES else f"{module}.__init__"


def test_the_table_has_every_room() -> None:
    rooms = {file.parent.name for file in (ROOT / "afkb").glob("*/__init__.py")}
    assert set(MAY_IMPORT) == rooms


@pytest.mark.parametrize("room", sorted(MAY_IMPORT))
def test_a_room_imports_what_the_table_lets_it(room: str) -> None:
    allowed = MAY_IMPORT[room] | FOR_ALL | {room}
    if "afkb" in allowed:
        return
    for module, file in FILES.items():
        if module.split(".")[1] == room:
            tree = ast.parse(file.read_text(encoding="utf-8"))
            rooms = {name.split(".")[1] for name in imported(ast.walk(tree))}
            assert rooms <= allowed, module


def test_no_two_modules_need_each_other_to_be_loaded() -> None:
    graph = {}
    for module, file in FILES.items():
        body = ast.parse(file.read_text(encoding="utf-8")).body
        graph[module] = set(imported(body)) - {module}
    order = list(TopologicalSorter(graph).static_order())
    assert len(order) == len(FILES)
