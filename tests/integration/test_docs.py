"""Whatever the documents tell people to type works.

- `bash`: run, all blocks of a document one after the other, in a folder that holds `demo-map`
  (made by `afkb demo`; `kitchen` is the same), `examples`, and, where the recordings are there,
  `my-recording` (some frames of one) and the folder that AFKB_DATA names.
- `sh`: setting up a machine, or an evaluation of minutes; not run, but what it names must exist.
- `python`: run, all blocks of a document one after the other.
- `sparql`: asked of the demo's map.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from documents import RUN_BY_THEIR_OWN_TESTS, Block, blocks, links
from running import ROOT

pytestmark = pytest.mark.xdist_group("integration")
FRAMES = 10


def needs_recordings(text: str) -> bool:
    return "my-recording" in text or "AFKB_DATA" in text


@pytest.fixture(scope="session")
def recordings() -> Path | None:
    folder = Path(os.environ.get("AFKB_DATA", ROOT.parent / "shared" / "data"))
    return folder if (folder / "redkitchen").is_dir() else None


@pytest.fixture(scope="session")
def desks(
    demo_folder: Path, recordings: Path | None, tmp_path_factory: pytest.TempPathFactory
) -> dict[str, Path]:
    """A working folder for each document, so that its blocks build on each other."""
    folders = {}
    for document in sorted({b.document for b in blocks("bash", "python")}):
        desk = tmp_path_factory.mktemp("desk")
        shutil.copytree(demo_folder / "demo-map", desk / "demo-map")
        (desk / "kitchen").symlink_to("demo-map")
        (desk / "examples").symlink_to(ROOT / "examples")
        (desk / "docs").symlink_to(ROOT / "docs")
        if recordings is not None:
            _some_frames(recordings / "redkitchen", desk / "my-recording")
        folders[document] = desk
    return folders


def _some_frames(recording: Path, into: Path) -> None:
    into.mkdir()
    wanted = sorted(recording.glob("frame-*.pose.txt"))[:FRAMES]
    stems = {p.name.split(".")[0] for p in wanted}
    for file in sorted(recording.iterdir()):
        if file.name.split(".")[0] in stems or not file.name.startswith("frame-"):
            (into / file.name).symlink_to(file)


@pytest.fixture(scope="session")
def environment(third_party: Path, recordings: Path | None) -> dict[str, str]:
    """As of someone who has followed the setup: `afkb` and the sample package installed."""
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    data = {"AFKB_DATA": str(recordings)} if recordings else {}
    return os.environ | {"PATH": path, "PYTHONPATH": str(third_party), "COLUMNS": "120"} | data


def _run(command: list[str], desk: Path, environment: dict[str, str], where: str) -> None:
    done = subprocess.run(
        command, cwd=desk, env=environment, capture_output=True, text=True, timeout=900, check=False
    )
    assert done.returncode == 0, f"{where}\n{done.stdout[-2000:]}\n{done.stderr[-4000:]}"


@pytest.mark.parametrize(
    "document", sorted({b.document for b in blocks("bash")} - set(RUN_BY_THEIR_OWN_TESTS))
)
def test_commands_run(
    document: str, desks: dict[str, Path], environment: dict[str, str], recordings: Path | None
) -> None:
    commands = [b for b in blocks("bash") if b.document == document]
    if recordings is None and any(needs_recordings(b.text) for b in commands):
        pytest.skip("needs recordings; set AFKB_DATA to a folder that holds redkitchen")
    for block in commands:
        script = ["bash", "-euo", "pipefail", "-c", block.text]
        _run(script, desks[document], environment, block.id)


@pytest.mark.parametrize("document", sorted({b.document for b in blocks("python")}))
def test_python_runs(
    document: str, desks: dict[str, Path], environment: dict[str, str], recordings: Path | None
) -> None:
    script = "\n".join(b.text for b in blocks("python") if b.document == document)
    if needs_recordings(script) and recordings is None:
        pytest.skip("needs recordings; set AFKB_DATA to a folder that holds redkitchen")
    _run([sys.executable, "-c", script], desks[document], environment, document)


@pytest.mark.parametrize("block", blocks("sparql"), ids=lambda b: b.id)
def test_queries_are_answered(block: Block, demo_folder: Path) -> None:
    from afkb.knowledge import AfNet
    from afkb.store import load, query

    answer = query([load(demo_folder / "demo-map")], block.text, AfNet().files)
    assert answer.columns or block.text.lstrip().upper().startswith(("ASK", "CONSTRUCT"))


@pytest.mark.parametrize("block", blocks("sh"), ids=lambda b: b.id)
def test_what_is_named_without_being_run_is_there(block: Block, recordings: Path | None) -> None:
    for line in block.text.strip().splitlines():
        command, *words = line.replace('"', "").split()
        for path in (w.removeprefix("$AFKB_DATA/") for w in words if w.startswith("$AFKB_DATA/")):
            assert recordings is None or (recordings / path).exists(), line
        if command == "make":
            subprocess.run(["make", "-n", *words], cwd=ROOT, check=True, capture_output=True)
        elif command == "sudo":
            packages = words[words.index("install") + 1 :]
            scripts = [ROOT / "scripts" / name for name in ("set-up.sh", "java.sh")]
            known = " ".join(s.read_text() for s in scripts) + " make git python3 python3-venv"
            assert all(re.search(rf"\b{re.escape(p)}\b", known) for p in packages), line
        elif command == "pip":
            paths = [w for w in words if "/" in w or w.startswith(".")]
            assert all((ROOT / p.split("[")[0]).exists() for p in paths), line
        elif command == "python":
            module = ROOT / words[1].replace(".", "/")
            assert module.with_suffix(".py").exists() or (module / "__main__.py").exists(), line
        else:
            others = {"cd", "dask", "git", "oxigraph", "source"}
            assert command in {"afkb", ".venv/bin/afkb"} | others, line


@pytest.mark.parametrize("document", RUN_BY_THEIR_OWN_TESTS)
def test_what_runs_elsewhere_has_a_test_that_runs_it(document: str) -> None:
    test = Path(__file__).parent / f"test_{Path(document).parent.name}.py"
    assert f'run_document("{document}"' in test.read_text(encoding="utf-8")


def test_the_pictures_are_plans_of_maps(demo_folder: Path, tmp_path: Path) -> None:
    out = tmp_path / "plan.svg"
    script = ROOT / "scripts" / "picture.py"
    subprocess.run([sys.executable, script, demo_folder / "demo-map", out, "edges"], check=True)
    plan = out.read_text()
    assert plan.startswith("<svg") and 'class="things"' in plan and 'class="edges"' not in plan
    assert (ROOT / "docs" / "demo-map.svg").read_text().startswith("<svg")


@pytest.mark.parametrize(("document", "target"), links())
def test_links_lead_somewhere(document: Path, target: str) -> None:
    assert (document.parent / target).exists(), f"{document.name} links to {target}"
