"""The host finds plugins, asks them, and says which one is at fault."""

from __future__ import annotations

from importlib.metadata import EntryPoint
from pathlib import Path

import pytest
import typer

from afkb.errors import PluginError, SourceError
from afkb.knowledge import AfNet
from afkb.plugins import hookimpl, hookspecs
from afkb.plugins import host as host_module
from afkb.plugins.host import PluginHost


class Named:
    """A thing with a name and a place in the order, all that the host looks at."""

    affordances = ("SupportAbility",)

    def __init__(self, name: str, stage: int = 0) -> None:
        self.name, self.stage, self.order = name, stage, stage


class Brings:
    """A plugin that brings detectors and remembers the knowledge base it was handed."""

    def __init__(self, *detectors: Named) -> None:
        self.detectors, self.handed = detectors, None

    @hookimpl
    def afkb_detectors(self, knowledge_base: AfNet) -> list[Named]:
        self.handed = knowledge_base
        return list(self.detectors)


@pytest.fixture
def host() -> PluginHost:
    return PluginHost()


def test_every_hook_is_used_by_a_built_in_plugin_or_is_for_strangers(host: PluginHost) -> None:
    used = {hook for plugin in host.plugins() for hook in plugin.hooks}
    offered = {name for name in vars(hookspecs) if name.startswith("afkb_")}
    assert offered - used <= {"afkb_ontologies"}


def test_built_in_plugins_come_through_the_entry_points_of_the_distribution(
    host: PluginHost,
) -> None:
    plugins = {p.name: p for p in host.plugins()}
    assert {"simulation", "surfaces", "mapping", "observed_only"} <= set(plugins)
    assert plugins["mapping"].distribution == "afkb"
    assert plugins["mapping"].module == "afkb_mapping.plugin"


def test_a_stand_in_runs_only_where_it_is_named(host: PluginHost) -> None:
    stand_in = Named("stand-in")
    stand_in.by_default = False
    host.register(Brings(stand_in), name="theirs")
    assert stand_in not in host.detectors()
    assert host.detectors(["stand-in"]) == [stand_in]


def test_a_registered_plugin_is_asked_and_handed_the_knowledge_base(host: PluginHost) -> None:
    plugin = Brings(Named("mine"))
    host.register(plugin, name="mine")
    assert [d.name for d in host.detectors(["mine"])] == ["mine"]
    assert plugin.handed is host.knowledge_base
    assert next(p for p in host.plugins() if p.name == "mine").hooks == ("afkb_detectors",)


class BringsAll:
    """A plugin with every hook."""

    extension = Path("extension.owl")

    @hookimpl
    def afkb_open_source(self, uri: str) -> str | None:
        return f"opened {uri}" if uri.startswith("mine:") else None

    @hookimpl
    def afkb_predictors(self) -> list[Named]:
        return [Named("my-predictor")]

    @hookimpl
    def afkb_mappers(self) -> list[Named]:
        return [Named("my-mapper")]

    @hookimpl
    def afkb_room_classifiers(self) -> list[Named]:
        return [Named("my-classifier")]

    @hookimpl
    def afkb_exporters(self) -> list[Named]:
        return [Named("my-exporter")]

    @hookimpl
    def afkb_ontologies(self) -> list[Path]:
        return [self.extension]

    @hookimpl
    def afkb_commands(self, cli: typer.Typer) -> None:
        cli.command("mine")(lambda: None)


def test_what_each_hook_returns_reaches_whoever_asks(
    host: PluginHost, monkeypatch: pytest.MonkeyPatch
) -> None:
    extended: list[Path] = []
    monkeypatch.setattr(AfNet, "extended", lambda self, paths: extended.extend(paths) or self)
    host.register(BringsAll(), name="all")
    assert host.open_source("mine:1") == "opened mine:1"
    assert host.predictors(["my-predictor"])[0].name == "my-predictor"
    assert host.mapper_factory("my-mapper").name == "my-mapper"
    assert host.room_classifiers(["my-classifier"])[0].name == "my-classifier"
    assert host.exporters(["my-exporter"])[0].name == "my-exporter"
    assert BringsAll.extension in extended


def test_commands_of_a_plugin_are_added_to_the_command_line(host: PluginHost) -> None:
    host.register(BringsAll(), name="all")
    cli = typer.Typer()
    host.manager.hook.afkb_commands(cli=cli, knowledge_base=host.knowledge_base)
    assert "mine" in {command.name for command in cli.registered_commands}


def test_detectors_come_coarse_before_fine_and_then_by_name(host: PluginHost) -> None:
    host.register(Brings(Named("z-late", 1), Named("b-early"), Named("a-early")))
    names = [d.name for d in host.detectors(["z-late", "b-early", "a-early"])]
    assert names[-1] == "z-late"
    assert [d.stage for d in host.detectors()] == sorted(d.stage for d in host.detectors())


def test_an_unknown_name_lists_what_there_is(host: PluginHost) -> None:
    with pytest.raises(PluginError, match=r"no mapper named 'nobody'; registered: .*observed-only"):
        host.mapper_factory("nobody")


def test_two_plugins_of_one_name_are_refused(host: PluginHost) -> None:
    host.register(Brings(Named("twin")), name="one")
    host.register(Brings(Named("twin")), name="two")
    with pytest.raises(PluginError, match="two detectors are named 'twin'"):
        host.detectors()


def test_a_plugin_that_does_not_import_is_named_with_its_mend(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    broken = EntryPoint(name="broken", value="no_such_module_here", group="afkb")
    monkeypatch.setattr(host_module, "entry_points", lambda group: [broken])
    with pytest.raises(PluginError, match=r"'broken'.*no_such_module_here.*pip uninstall"):
        PluginHost()


def test_a_hook_with_a_wrong_parameter_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    class Wrong:
        @hookimpl
        def afkb_detectors(self, ontology: object) -> list[Named]:
            return []

    entry = EntryPoint(name="wrong", value="anything", group="afkb")
    monkeypatch.setattr(host_module, "entry_points", lambda group: [entry])
    monkeypatch.setattr(EntryPoint, "load", lambda self: Wrong())
    with pytest.raises(PluginError, match=r"'wrong'.*ontology"):
        PluginHost()


def test_a_missing_path_and_an_unrecognised_one_are_told_apart(
    host: PluginHost, tmp_path: Path
) -> None:
    with pytest.raises(SourceError, match="no such file"):
        host.open_source(str(tmp_path / "gone"))
    strange = tmp_path / "notes.docx"
    strange.write_text("no recording")
    with pytest.raises(SourceError, match=r"recognises"):
        host.open_source(str(strange))
