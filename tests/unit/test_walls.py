"""The walls of the house stand: who may import whom, and what stays light."""

from __future__ import annotations

import ast
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PLUGINS = sorted(p.name for p in (ROOT / "plugins").glob("afkb_*"))
HEAVY = ("open3d", "numba", "pgmpy", "owlready2", "cv2", "rosbags", "scipy", "rdflib")


def imported(folder: Path) -> dict[str, set[str]]:
    """For each file below the folder the packages that it imports, at the top or within."""
    found = {}
    for path in sorted(folder.rglob("*.py")):
        names = set()
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Import):
                names |= {alias.name for alias in node.names}
            elif isinstance(node, ast.ImportFrom) and node.module:
                names.add(node.module)
        found[path.relative_to(ROOT).as_posix()] = names
    return found


def importers(folder: Path, *forbidden: str) -> list[str]:
    return [
        f"{path} imports {name}"
        for path, names in imported(folder).items()
        for name in sorted(names)
        if name.split(".")[0] in forbidden
    ]


def test_afkb_imports_neither_mapping_nor_a_plugin() -> None:
    assert not importers(ROOT / "afkb", "afkb_mapping", *PLUGINS)


def test_mapping_imports_no_plugin() -> None:
    assert not importers(ROOT / "mapping", *PLUGINS)


def test_the_flow_is_plain_data() -> None:
    for path, names in imported(ROOT / "afkb" / "flow").items():
        inner = {n for n in names if n.startswith("afkb")}
        assert all(n.startswith(("afkb.flow", "afkb.errors")) for n in inner), path


@pytest.mark.parametrize("folder", ["afkb", "mapping", "plugins"])
def test_no_shipped_code_imports_tests_or_benchmarks(folder: str) -> None:
    assert not importers(ROOT / folder, "bench", "tests", "pytest", "hypothesis")


def test_every_built_in_plugin_is_registered() -> None:
    from importlib.metadata import entry_points

    modules = {e.module for e in entry_points(group="afkb")}
    assert set(PLUGINS) <= modules


def test_the_command_line_starts_without_heavy_libraries() -> None:
    code = (
        "import sys\n"
        "from afkb.cli.app import build_cli\n"
        "from afkb.plugins.host import PluginHost\n"
        "build_cli(PluginHost())\n"
        f"print(*(n for n in {HEAVY!r} if n in sys.modules))\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == []


def test_files_are_small() -> None:
    lengths = {
        path.relative_to(ROOT).as_posix(): len(path.read_text(encoding="utf-8").splitlines())
        for folder in ("afkb", "mapping", "plugins", "bench", "tests", "scripts", "examples")
        for path in (ROOT / folder).rglob("*.py")
    }
    assert not {path: n for path, n in lengths.items() if n > 400}
    assert sorted(lengths.values())[len(lengths) // 2] <= 120
