from __future__ import annotations

import csv
import io
import json
import signal
import subprocess
import sys
from pathlib import Path
from typing import Annotated

import pytest
import typer
from typer.testing import CliRunner, Result

from afkb.cli.app import build_cli
from afkb.cli.state import state_of
from afkb.errors import PluginError, SourceError
from afkb.plugins import hookimpl
from afkb.plugins.host import PluginHost
from afkb.store import write_map
from store_samples import Names, sample_map


class Stranger:
    """A plugin with commands that end in every way a command can."""

    @hookimpl
    def afkb_commands(self, cli: typer.Typer) -> None:
        @cli.command()
        def greet(ctx: typer.Context, name: Annotated[str, typer.Argument()]) -> None:
            typer.echo(f"{name} of {len(state_of(ctx).host.plugins())} plugins")

        @cli.command()
        def fail(how: str) -> None:
            if how == "interrupt":
                raise KeyboardInterrupt
            raise {"input": SourceError("run.bag:\nno depth"), "bug": ZeroDivisionError("oh")}[how]


@pytest.fixture(scope="module")
def host() -> PluginHost:
    host = PluginHost()
    host.register(Stranger(), "stranger")
    return host


@pytest.fixture(scope="module")
def home(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_map(tmp_path_factory.mktemp("maps") / "home", sample_map(), {}, [], Names())


@pytest.fixture(scope="module")
def run(host: PluginHost):  # type: ignore[no-untyped-def]
    cli = build_cli(host)

    def invoke(*arguments: str) -> Result:
        return CliRunner().invoke(cli, arguments)

    return invoke


def test_info_shows_nodes_by_kind(run, home: Path) -> None:
    shown = run("info", str(home)).stdout
    assert "CoOccurrencePrediction" in shown and "Mug 0.60" in shown and "loop closed by" in shown
    told = json.loads(run("info", str(home), "--json").stdout)
    assert told["kinds"]["RobotPlace"] == 2
    keys = {
        "id",
        "kind",
        "x",
        "y",
        "z",
        "size",
        "yaw",
        "affords",
        "existence",
        "category",
        "room",
        "supported_by",
    }
    assert all(keys <= set(node) for node in told["nodes"])


def test_rooms_show_their_posterior(run, home: Path) -> None:
    assert "Kitchen 0.70" in run("rooms", str(home)).stdout
    told = json.loads(run("rooms", str(home), "--json").stdout)
    assert {"id", "belief", "area", "polygon"} <= set(told[0])
    assert sum(told[0]["belief"].values()) == pytest.approx(1)


def test_query_in_every_format(run, home: Path, tmp_path: Path) -> None:
    select = "SELECT ?c { ?c afn:affords afn:ContainAbility }"
    assert "scene:n2" in run("query", str(home), select).stdout
    told = json.loads(run("query", str(home), select, "--format", "json").stdout)
    assert told["results"]["bindings"][0]["c"]["value"].endswith("#n2")
    assert told == json.loads(run("query", str(home), select, "--json").stdout)
    rows = list(csv.reader(io.StringIO(run("query", str(home), select, "--format", "csv").stdout)))
    assert rows[0] == ["c"] and len(rows) == 2
    construct = "CONSTRUCT WHERE { ?r a afn:Room }"
    assert "afn:Room" in run("query", str(home), construct, "--format", "ttl").stdout
    file = tmp_path / "q.rq"
    file.write_text(select)
    assert "scene:n2" in run("query", str(home), "--file", str(file)).stdout


def test_query_asks_several_maps_and_the_ontology(run, home: Path) -> None:
    select = "SELECT DISTINCT ?label { ?n afn:affords ?a . ?a rdfs:label|skos:prefLabel ?label }"
    asked = run("query", "--map", str(home), "--map", str(home), select, "--format", "csv")
    assert asked.exit_code == 0
    assert "contain" in asked.stdout


def test_the_library_of_queries(run, home: Path) -> None:
    assert "@containers-on-supports" in run("query", "--list").stdout
    assert "scene:n1" in run("query", str(home), "@containers-on-supports").stdout
    missing = run("query", str(home), "@nothing")
    assert missing.exit_code == 1 and missing.stderr.startswith("error: no named query")


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["info", "nowhere"], "nowhere: no such map"),
        (["rooms", "nowhere"], "nowhere: no such map"),
        (["query", "nowhere", "ASK {}"], "nowhere: no such map"),
        (["query", "HOME", "SELECT ?s WHER { }"], "line 1, column 11"),
        (["query", "HOME", "DROP ALL"], "read-only"),
        (["query", "HOME", "--file", "nowhere.rq"], "nowhere.rq"),
        (["query", "HOME", "ASK {}", "--ontology", "nowhere.owl"], "nowhere.owl"),
        (["plugins", "--hook", "afkb_tea"], "no hook named 'afkb_tea'"),
        (["fail", "input"], "run.bag: no depth"),
        (["fail", "bug"], "unexpected ZeroDivisionError: oh - run again with --debug"),
    ],
)
def test_failures_are_one_line_and_exit_1(run, home: Path, arguments: list[str], told: str) -> None:
    result = run(*(str(home) if a == "HOME" else a for a in arguments))
    assert result.exit_code == 1
    assert result.stderr.startswith("error: ") and told in result.stderr
    assert result.stderr.count("\n") == 1 and not result.stdout


@pytest.mark.parametrize(
    "arguments",
    [
        ["info"],
        ["query"],
        ["query", "m"],
        ["query", "m", "ASK {}", "more"],
        ["bogus"],
        ["rooms", "m", "--bogus"],
        ["query", "m", "ASK {}", "--format", "docx"],
    ],
)
def test_wrong_usage_exits_2(run, arguments: list[str]) -> None:
    assert run(*arguments).exit_code == 2


def test_an_interrupt_exits_130(run) -> None:
    assert run("fail", "interrupt").exit_code == 130


def test_commands_of_a_plugin_reach_the_host(run, host: PluginHost) -> None:
    assert run("greet", "one").stdout == f"one of {len(host.plugins())} plugins\n"


def test_a_plugin_that_cant_add_its_commands_is_named() -> None:
    class Bad:
        @hookimpl
        def afkb_commands(self, cli: typer.Typer) -> None:
            raise ImportError("No module named 'teapot'")

    host = PluginHost()
    host.register(Bad(), "bad")
    with pytest.raises(PluginError, match=r"plugin 'bad'.*teapot"):
        build_cli(host)


def test_plugins_are_listed_with_their_origin(run) -> None:
    assert "afkb_detectors" in run("plugins").stdout
    told = json.loads(run("plugins", "--hook", "afkb_exporters", "--json").stdout)
    assert {"nav2", "report"} <= {plugin["name"] for plugin in told}
    assert all("afkb_exporters" in plugin["hooks"] for plugin in told)
    assert {"name", "module", "distribution", "version", "hooks"} == set(told[0])


def test_every_command_has_help_with_an_example(run, host: PluginHost) -> None:
    commands = typer.main.get_command(build_cli(host)).commands  # type: ignore[attr-defined]
    ours = [n for n in commands if n not in ("greet", "fail", "ontology")]
    assert {"info", "rooms", "query", "plugins", "map", "demo"} <= set(ours)
    for name in ours:
        shown = run(name, "--help")
        assert shown.exit_code == 0
        assert "Example: afkb" in shown.stdout, name


def afkb(*arguments: str, **options: object) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "afkb.cli.app", *arguments],
        capture_output=True,
        text=True,
        check=False,
        timeout=60,
        **options,  # type: ignore[call-overload]
    )


def test_the_real_program(home: Path) -> None:
    assert afkb("--version").stdout.startswith("afkb ")
    failed = afkb("info", "nowhere")
    assert failed.returncode == 1
    assert failed.stderr.startswith("error: nowhere: no such map") and not failed.stdout
    assert "Traceback" in afkb("info", "nowhere", "--debug").stderr
    assert afkb("bogus").returncode == 2


def test_a_reader_that_has_enough_is_no_error(home: Path) -> None:
    sparql = "SELECT * { ?a ?b ?c . ?d ?e ?f } LIMIT 20000"
    with subprocess.Popen(
        [sys.executable, "-m", "afkb.cli.app", "query", str(home), sparql, "--format", "csv"],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    ) as child:
        assert child.stdout is not None and child.stderr is not None
        child.stdout.readline()
        child.stdout.close()
        assert child.stderr.read() == b""


def test_help_loads_nothing_heavy() -> None:
    code = (
        "import sys\nfrom afkb.cli.app import main\n"
        "try: main(['--help'])\nexcept SystemExit: pass\n"
        "heavy = {'open3d', 'numba', 'pgmpy', 'owlready2', 'cv2', 'rosbags', 'rdflib', 'scipy'}\n"
        "print('loaded:', sorted(heavy & set(sys.modules)))"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=60
    )
    assert "loaded: []" in done.stdout


def test_ctrl_c_in_the_real_program_exits_130(tmp_path: Path) -> None:
    code = (
        "import os, signal\nfrom afkb.cli.app import main\n"
        "import afkb.store\n"
        "def stuck(folder): os.kill(os.getpid(), signal.SIGINT)\n"
        "afkb.store.load = stuck\n"
        f"main(['info', {str(tmp_path)!r}])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, timeout=60)
    assert done.returncode in (130, -signal.SIGINT)
    assert b"Traceback" not in done.stderr
