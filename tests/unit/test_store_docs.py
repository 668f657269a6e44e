from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
from typer.testing import CliRunner

from afkb.knowledge import AfNet
from afkb.store import Dataset, StoredMap, load, write_map
from afkb.store.named import named_queries
from afkb.store.shapes import info_json, node_json, rooms_json
from store_samples import Names, sample_map

DOCS = Path(__file__).parents[2] / "docs"
COOKBOOK = (DOCS / "sparql-cookbook.md").read_text(encoding="utf-8")
REFERENCE = (DOCS / "reference.md").read_text(encoding="utf-8")


def blocks(text: str, language: str) -> list[str]:
    return re.findall(rf"```{language}\n(.*?)```", text, re.DOTALL)


@pytest.fixture(scope="module")
def stored(tmp_path_factory: pytest.TempPathFactory) -> StoredMap:
    folder = tmp_path_factory.mktemp("maps") / "demo-map"
    (folder.parent / "kitchen").symlink_to("demo-map")
    return load(write_map(folder, sample_map(), {}, [], Names()))


@pytest.fixture(scope="module")
def everything(stored: StoredMap) -> Dataset:
    return Dataset.load([stored], AfNet().files)


@pytest.mark.parametrize("sparql", blocks(COOKBOOK, "sparql"))
def test_every_question_of_the_cookbook_has_an_answer(everything: Dataset, sparql: str) -> None:
    answer = everything.ask(sparql)
    assert answer.truth or answer.rows


def test_the_cookbook_lists_the_library() -> None:
    told = re.findall(r"^\| `@(\S+)` \| (.*?) \| (.+?) \|$", COOKBOOK, re.MULTILINE)
    assert told == [
        (q.name, " ".join(f"`{p.name}={p.default}`" for p in q.parameters), q.about)
        for q in named_queries()
    ]


def test_the_python_of_the_cookbook_runs(
    stored: StoredMap, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(stored.folder.parent)
    for code in blocks(COOKBOOK, "python"):
        exec(compile(code, "sparql-cookbook.md", "exec"), {})


def test_the_plugin_command_of_the_reference_runs(stored: StoredMap) -> None:
    from afkb.cli.app import build_cli
    from afkb.plugins.host import PluginHost

    names: dict[str, object] = {"__name__": "census"}
    exec(compile(blocks(REFERENCE, "python")[0], "reference.md", "exec"), names)
    host = PluginHost()
    host.register(type("Plugin", (), {"afkb_commands": staticmethod(names["afkb_commands"])})())
    done = CliRunner().invoke(build_cli(host), ["census", str(stored.folder)])
    assert json.loads(done.stdout)["kinds"]["Room"] == 2


def test_the_reference_lists_every_term_and_key(stored: StoredMap) -> None:
    scene = (stored.folder / "scene.ttl").read_text(encoding="utf-8")
    used = set(re.findall(r"\tafn:(\w+) ", scene))
    used -= {"count", "formatVersion", "viewIndex", "probability"}
    missing = {term for term in used if f"`afn:{term}`" not in REFERENCE}
    assert not missing
    keys = set(info_json(stored)) | set(rooms_json(stored)[0])
    keys |= set(node_json(stored, stored.instances("ObservedEntity")[0], "ObservedEntity"))
    assert not {key for key in keys if f'"{key}"' not in REFERENCE and f"`{key}`" not in REFERENCE}


def test_the_ontology_declares_every_term_of_a_scene(everything: Dataset) -> None:
    sparql = """
        SELECT DISTINCT ?term WHERE {
          GRAPH ?map { { ?s ?term ?o } UNION { ?s a ?term } }
          FILTER (?map != <urn:afkb:ontology> && STRSTARTS(STR(?term), STR(afn:)))
          FILTER NOT EXISTS { GRAPH <urn:afkb:ontology> { ?term skos:definition ?definition } }
        }"""
    assert everything.ask(sparql).cells() == []
