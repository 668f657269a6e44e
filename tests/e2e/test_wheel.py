"""The wheel, alone in an environment, works: nothing leans on the checkout."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import sysconfig
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
pytestmark = pytest.mark.xdist_group("wheel")


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("dist")
    build = [sys.executable, "-m", "build", "--wheel", "--no-isolation", "--outdir", str(out)]
    subprocess.run([*build, str(ROOT)], check=True, capture_output=True)
    (built,) = out.glob("*.whl")
    return built


@pytest.fixture(scope="module")
def environment(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A new environment with the wheel in it, and this one's libraries, the project left out."""
    folder = tmp_path_factory.mktemp("environment")
    venv, libraries = folder / "venv", folder / "libraries"
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", venv], check=True)
    libraries.mkdir()
    for entry in Path(sysconfig.get_path("purelib")).iterdir():
        if "afkb" not in entry.name:
            (libraries / entry.name).symlink_to(entry)
    (site,) = venv.glob("lib/python*/site-packages")
    (site / "libraries.pth").write_text(f"{libraries}\n")
    pip = [sys.executable, "-m", "pip", "--python", str(venv / "bin" / "python"), "install"]
    subprocess.run([*pip, "--quiet", "--no-deps", "--no-index", str(wheel)], check=True)
    return venv / "bin"


def run(environment: Path, cwd: Path, program: str, *arguments: str) -> str:
    clean = {k: v for k, v in os.environ.items() if not k.startswith(("PYTHON", "AFKB"))}
    done = subprocess.run(
        [environment / program, *arguments],
        cwd=cwd,
        env=clean,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def folder(environment: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Where the installed `afkb map` has made `home` of the bundled home.

    With the one detector that compiles least, as each compiles anew in a new place.
    """
    cwd = tmp_path_factory.mktemp("cwd")
    few = ("--detector", "laser-bounds", "--stop", "4")
    run(environment, cwd, "afkb", "map", "world:paper_home", "--out", "home", *few)
    return cwd


def test_the_wheel_holds_what_is_needed_and_no_more(wheel: Path) -> None:
    names = zipfile.ZipFile(wheel).namelist()
    for needed in (
        "afkb/_ontology/afnet.owl",
        "afkb/_ontology/shapes/afbits.ttl",
        "afkb/_ontology/counts/rooms.csv",
        "afkb/py.typed",
        "afkb/testing/__init__.py",
        "afkb_simulation/worlds/paper_home.world.yaml",
        "afkb/drawing/assets/board.html",
        "afkb_report/page.html",
        "afkb_things/calibration.csv",
    ):
        assert needed in names
    tops = {n.split("/")[0] for n in names}
    assert all(t.startswith("afkb") for t in tops), tops
    assert "afkb/starters/files/tables/README.md" in names  # a template that `new` copies
    documents = [n for n in names if n.endswith(".md") and not n.startswith("afkb/starters/")]
    assert not [n for n in names if n.endswith(".pyc")] + documents


def test_the_bundled_home_is_mapped(folder: Path) -> None:
    made = {p.name for p in (folder / "home").iterdir()}
    assert {"scene.ttl", "map.json", "occupancy.pgm", "report.html", "run.json"} <= made


def test_a_map_can_be_asked(environment: Path, folder: Path) -> None:
    kinds = json.loads(run(environment, folder, "afkb", "info", "home", "--json"))
    assert kinds
    asked = "SELECT ?l WHERE { afn:Mug rdfs:label ?l }"
    assert "mug" in run(environment, folder, "afkb", "query", "home", asked, "--format", "csv")


def test_plugins_come_from_the_wheel(environment: Path, tmp_path: Path) -> None:
    listed = json.loads(run(environment, tmp_path, "afkb", "plugins", "--json"))
    assert {p["distribution"] for p in listed} == {"afkb"}
    assert len(listed) >= 12


def test_every_module_comes_from_the_environment(environment: Path, tmp_path: Path) -> None:
    code = """
import sys
from afkb.plugins.host import PluginHost
host = PluginHost()
host.detectors(), host.predictors(), host.exporters(), host.mapper_factory("affordance")
print(host.knowledge_base.files[0])
for name, module in sys.modules.items():
    if name.startswith("afkb"):
        print(module.__file__)
"""
    files = run(environment, tmp_path, "python", "-c", code).split()
    assert len(files) > 20
    assert all(Path(f).is_relative_to(environment.parent) for f in files)
