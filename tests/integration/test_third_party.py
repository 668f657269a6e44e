"""A stranger's package is installed and used without a word of it in this project."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

from running import ROOT, run_afkb, run_document

PACKAGE = ROOT / "examples" / "third_party"
pytestmark = pytest.mark.xdist_group("examples")

CHECKS = """
from pathlib import Path
from afkb import testing
from afkb.plugins.host import PluginHost
host = PluginHost()
earlier = host.detectors(["surfaces"])
testing.check_detector(
    host.detectors(["balls"])[0], testing.sample_views(), host.knowledge_base, earlier
)
testing.check_mapper_factory(host.mapper_factory("skeleton"), host.knowledge_base)
import afkb_playroom
testing.check_ontology(afkb_playroom.afkb_ontologies()[0], host.knowledge_base)
"""


@pytest.fixture(scope="module")
def playroom(third_party: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder that holds the map `playroom`, made with the package's detector and mapper."""
    folder = tmp_path_factory.mktemp("playroom")
    run_document("examples/third_party/README.md", folder, third_party)
    return folder


def test_it_is_listed_with_the_package_it_came_from(third_party: Path, tmp_path: Path) -> None:
    listed = json.loads(run_afkb("plugins", "--json", cwd=tmp_path, extra_path=third_party))
    mine = next(p for p in listed if p["name"] == "playroom")
    assert (mine["distribution"], mine["version"]) == ("afkb-playroom", "0.1.0")
    assert set(mine["hooks"]) == {"afkb_detectors", "afkb_mappers", "afkb_ontologies"}


def test_without_it_nothing_of_it_is_there(tmp_path: Path) -> None:
    assert "playroom" not in run_afkb("plugins", "--json", cwd=tmp_path)


def test_its_parts_keep_their_contracts(third_party: Path) -> None:
    path = f"import sys; sys.path.insert(0, {str(third_party)!r})\n"
    done = subprocess.run([sys.executable, "-c", path + CHECKS], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def test_its_detector_and_mapper_made_the_map(playroom: Path, third_party: Path) -> None:
    run = json.loads((playroom / "playroom" / "run.json").read_text())
    assert run["parameters"]["mapper"] == "skeleton"
    asked = "SELECT ?n ?size WHERE { ?n afn:affords afn:RollAbility3D ; afn:sizeX ?size }"
    balls = _answers(playroom, third_party, asked)
    assert sorted(float(b["size"]["value"]) for b in balls) == pytest.approx([0.22, 0.9], abs=0.05)


def test_its_category_is_in_the_answer_to_a_query(playroom: Path, third_party: Path) -> None:
    query = (PACKAGE / "giant-balls.rq").read_text()
    (ball,) = _answers(playroom, third_party, query)
    # In the world file at (3.0, 1.2); the map's origin is the first base pose (0.8, 1.8, 10°).
    assert float(ball["x"]["value"]) == pytest.approx(2.06, abs=0.1)
    assert float(ball["y"]["value"]) == pytest.approx(-0.97, abs=0.1)


def test_its_category_has_its_label_from_the_extension(playroom: Path, third_party: Path) -> None:
    asked = (
        "PREFIX play: <https://example.org/playroom#> "
        "SELECT ?label WHERE { play:GiantBall rdfs:label ?label }"
    )
    (row,) = _answers(playroom, third_party, asked)
    assert row["label"]["value"] == "giant ball"


def _answers(folder: Path, third_party: Path, query: str) -> list[dict[str, dict[str, str]]]:
    out = run_afkb(
        "query", "playroom", query, "--format", "json", cwd=folder, extra_path=third_party
    )
    return json.loads(out)["results"]["bindings"]  # type: ignore[no-any-return]
