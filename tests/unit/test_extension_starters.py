"""Starters pass as they are; extensions reach the command line, queries and plugins' users."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import pytest
from typer.testing import CliRunner

from afkb.cli.app import build_cli
from afkb.inference import Network
from afkb.knowledge import AfNet
from afkb.plugins import hookimpl
from afkb.plugins.host import PluginHost
from afkb.quality.checked import Checked
from afkb.quality.pitfalls import check_pitfalls
from afkb.quality.shape_check import check_shapes, read_shapes
from afkb.starters import Kind, write_starter
from afkb.store import query
from afkb.testing import check_ontology
from extension_samples import KIOSK, table, yaml_file

NAMES = ["my-home.yaml", "my-home.csv", "my-home", "my-home.owl"]


@pytest.mark.parametrize("name", NAMES)
def test_a_starter_is_read_and_known_to_the_network(tmp_path: Path, name: str) -> None:
    write_starter(tmp_path / name)
    base = AfNet(extensions=[tmp_path / name])
    assert base.categories["Terrarium"].iri == "https://example.org/my-home#Terrarium"
    assert "Terrarium" in Network.compile(base).category_posterior(
        {"ContainAbility": 0.9}, (0.5, 0.3, 0.4), 1.2
    )


@pytest.mark.parametrize("name", ["my-home.yaml", "my-home.owl"])
def test_a_starter_passes_the_gates_of_shapes_and_pitfalls(tmp_path: Path, name: str) -> None:
    write_starter(tmp_path / name)
    files = AfNet().files
    checked = Checked.of_files([tmp_path / name], files)
    assert check_shapes(checked, read_shapes(files[0].parent / "shapes")) == []
    assert [f for f in check_pitfalls(checked) if not f.advice] == []


def test_the_samples_of_the_yaml_starter_can_be_taken_as_they_are(tmp_path: Path) -> None:
    (path,) = write_starter(tmp_path / "my-home.yaml")
    lines = path.read_text(encoding="utf-8").splitlines()
    path.write_text("\n".join(line.removeprefix("# ") for line in lines), encoding="utf-8")
    table(tmp_path, "my-rooms.csv", "building,room,category,objects", "flat,1,Kitchen,cup:2")
    base = AfNet(extensions=[path])
    assert base.features["GrowAbility"].parameters["area_m2"](0.5) == 1.0
    assert base.rooms["PottingRoom"].expected_counts["PlantBenchSupport"] == 1
    assert base.rooms["StorageRoom"].expected_counts["PlantBenchSupport"] == 0.2
    assert base.categories["Bookshelf"].afbits["HangAbility"] == 0.2
    assert base.parameters["DampnessLimit"] == 0.7


def run(*arguments: str) -> tuple[int, str]:
    result = CliRunner().invoke(build_cli(PluginHost()), list(arguments))
    return result.exit_code, result.output


@pytest.mark.parametrize(("name", "kind"), [("a.yaml", "yaml"), ("a", "table"), ("a.owl", "owl")])
def test_the_command_writes_a_starter_and_never_writes_over(
    tmp_path: Path, name: str, kind: str
) -> None:
    path = tmp_path / name
    code, said = run("ontology", "new", str(path), "--kind", kind)
    assert code == 0 and f"afkb ontology check {path}" in said.replace("\n", "")
    content = sorted(p.read_bytes() for p in [path, *path.rglob("*")] if p.is_file())
    code, said = run("ontology", "new", str(path))
    assert code == 1 and "is there already; choose another name, or remove it" in said
    assert content == sorted(p.read_bytes() for p in [path, *path.rglob("*")] if p.is_file())


@pytest.mark.parametrize(
    ("name", "kind", "message"),
    [
        ("a.txt", None, "its name does not tell what to write; end it in .yaml, .csv or .owl"),
        ("a.owl", "yaml", "for --kind yaml, end the name in .yaml or .yml"),
        ("no/folder/a.yaml", None, "can't be written: No such file or directory"),
    ],
)
def test_what_it_can_t_write_is_said(
    tmp_path: Path, name: str, kind: str | None, message: str
) -> None:
    options = ["--kind", kind] if kind else []
    code, said = run("ontology", "new", str(tmp_path / name), *options)
    assert code == 1 and message in " ".join(said.split())


def test_every_kind_has_a_starter(tmp_path: Path) -> None:
    for kind, name in zip(Kind, ("a.yaml", "b.csv", "c.owl"), strict=True):
        assert write_starter(tmp_path / name, kind) == [tmp_path / name]


def test_the_command_line_says_each_problem_on_a_line_of_its_own(tmp_path: Path) -> None:
    body = KIOSK.replace("[0.4, 0.8]", "[0.8, 0.4]") + "    scale: Largish\n"
    path = yaml_file(tmp_path, body)
    code, said = run("ontology", "show", "Kiosk", "--ontology", str(path))
    assert code == 1
    assert [line.split(": ")[1] for line in said.splitlines()] == [
        f"{path}, line 5",
        f"{path}, line 8",
    ]


def test_queries_know_the_words_of_an_extension(tmp_path: Path) -> None:
    path = yaml_file(tmp_path, KIOSK)
    asked = (
        "PREFIX home: <https://example.org/home#> SELECT ?label WHERE { "
        "home:Kiosk rdfs:label ?label ; skos:broader afn:Furniture }"
    )
    assert [row[0] for row in query([], asked, AfNet(extensions=[path]).files).cells()] == ["kiosk"]


class Brings:
    """A plugin that brings extensions in two forms."""

    def __init__(self, *files: Path) -> None:
        self._files = files

    @hookimpl
    def afkb_ontologies(self) -> Iterable[Path]:
        return self._files


def test_a_plugin_brings_extensions_that_stack_with_the_user_s(tmp_path: Path) -> None:
    kiosk = yaml_file(tmp_path, KIOSK, "kiosk.yaml")
    afbits = table(tmp_path, "afbits.csv", "category,feature,strength", "Kiosk,HangAbility,0.6")
    host = PluginHost()
    host.register(Brings(kiosk, afbits), name="shop")
    mine = yaml_file(tmp_path, "afbits: [Kiosk > StackAbility = 0.1]\n", "mine.yaml")
    known = host.knowledge_base.extended([mine])
    assert (
        known.categories["Kiosk"].afbits.items()
        >= {"HangAbility": 0.6, "StackAbility": 0.1}.items()
    )
    check_ontology(kiosk, AfNet())
