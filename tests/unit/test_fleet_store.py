"""Maps in a SPARQL server: a real Oxigraph process, killed at the worst moments."""

import threading
from dataclasses import replace

import pytest
from typer.testing import CliRunner

from afkb.errors import EndpointError, MapError
from afkb.fleet import Keeper, PushState, Server, kept_maps, map_graph, named, push, remove
from afkb.fleet.pushing import ATTEMPTS
from afkb.fleet.statements import digest_of, portions, statements_of
from afkb.store import load, write_map
from oxigraph_server import OxigraphServer, oxigraph_server
from store_samples import Names, sample_map


@pytest.fixture(scope="module")
def maps(tmp_path_factory):
    """The same home on two days, as map folders."""
    folder = tmp_path_factory.mktemp("maps")
    later = replace(sample_map(), notes=("a later day",), closures=())
    before = load(write_map(folder / "kitchen", sample_map(), {}, [], Names()))
    return before, load(write_map(folder / "later", later, {}, [], Names()))


@pytest.fixture(scope="module")
def oxigraph(tmp_path_factory):
    with oxigraph_server(tmp_path_factory.mktemp("oxigraph")) as server:
        yield server


@pytest.fixture
def server(oxigraph: OxigraphServer):
    found = Server.find(oxigraph.url, patience_s=20)
    yield found
    for kept in kept_maps(found):
        remove(found, kept.name)
    assert graphs(found) == []


def graphs(server: Server) -> list[str]:
    rows = server.ask("SELECT DISTINCT ?g WHERE { GRAPH ?g { ?s ?p ?o } } ORDER BY ?g")
    return [row["g"] for row in rows]


def kept(server: Server, name: str) -> str:
    return digest_of(server.triples(map_graph(name)))


def digest(stored) -> str:
    return digest_of(statements_of(stored))


def test_a_map_is_kept_as_it_is_and_sent_once(server, maps):
    assert push(server, maps[0], "kitchen").state is PushState.STORED
    assert kept(server, "kitchen") == digest(maps[0])
    assert push(server, maps[0], "kitchen").state is PushState.ALREADY_THERE
    listed = kept_maps(server)
    assert [(k.name, k.triples) for k in listed] == [("kitchen", len(statements_of(maps[0])))]


def test_a_later_map_takes_its_place_and_others_stay(server, maps):
    push(server, maps[0], "north/kitchen")
    push(server, maps[0], "kitchen")
    push(server, maps[1], "kitchen")
    assert kept(server, "kitchen") == digest(maps[1])
    assert kept(server, "north/kitchen") == digest(maps[0])
    assert graphs(server) == [
        "urn:afkb:map:kitchen", "urn:afkb:map:north/kitchen", "urn:afkb:maps"
    ]  # fmt: skip


class LosingAnswers(Server):
    """Every update is done, and every other answer is lost: so each is sent twice."""

    def update(self, sparql: str) -> None:
        super().update(sparql)
        super().update(sparql)


def test_updates_done_twice_double_nothing_and_lose_nothing(server, maps):
    twice = LosingAnswers(server.query_at, server.update_at)
    push(twice, maps[0], "kitchen")
    push(twice, maps[1], "kitchen")
    assert kept(server, "kitchen") == digest(maps[1])


class Dying(Server):
    """Stops before its n-th update, as a killed program does."""

    def __init__(self, server: Server, updates: int) -> None:
        super().__init__(server.query_at, server.update_at)
        object.__setattr__(self, "left", [updates])

    def update(self, sparql: str) -> None:
        if not self.left[0]:  # type: ignore[attr-defined]
            raise KeyboardInterrupt
        self.left[0] -= 1  # type: ignore[attr-defined]
        super().update(sparql)


def test_wherever_a_program_dies_the_map_is_the_old_or_the_new_and_it_goes_on(
    server, maps, monkeypatch
):
    monkeypatch.setattr(portions, "__defaults__", (4000,))
    push(server, maps[0], "kitchen")
    old, new = digest(maps[0]), digest(maps[1])
    seen = []
    for updates in range(100):
        try:
            push(Dying(server, updates), maps[1], "kitchen")
        except KeyboardInterrupt:
            seen.append(kept(server, "kitchen"))
            continue
        break
    assert set(seen) <= {old, new} and seen[0] == old
    assert kept(server, "kitchen") == new
    assert graphs(server) == ["urn:afkb:map:kitchen", "urn:afkb:maps"]


def test_a_server_that_dies_in_the_middle_and_comes_back_has_all_of_it(tmp_path, maps):
    with oxigraph_server(tmp_path / "data") as process:
        server = Server.find(process.url, patience_s=30)
        push(server, maps[0], "kitchen")
        update, died = Server.update, []

        def dies_once(self: Server, sparql: str) -> None:
            if "DROP SILENT" in sparql and not died:
                died.append(True)
                process.kill()
                threading.Timer(0.3, process.start).start()
            update(self, sparql)

        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(Server, "update", dies_once)
            assert push(server, maps[1], "kitchen").state is PushState.STORED
        assert died
        assert kept(server, "kitchen") == digest(maps[1])


def test_a_server_that_keeps_something_else_is_told_of(server, maps):
    push(server, maps[0], "kitchen")
    sent = []

    class Forgetful(Server):
        def update(self, sparql: str) -> None:
            if "INSERT DATA" in sparql and ":staging:" in sparql and "isVersionOf" not in sparql:
                sent.append(sparql)
                return
            super().update(sparql)

    with pytest.raises(EndpointError, match=r"does not keep .* as it was sent"):
        push(Forgetful(server.query_at, server.update_at), maps[1], "kitchen")
    assert len(sent) == ATTEMPTS
    assert kept(server, "kitchen") == digest(maps[0])


def test_a_server_that_is_away_while_mapping_gets_the_map_afterwards(tmp_path, maps):
    with oxigraph_server(tmp_path / "data") as process:
        process.kill()
        told = []
        keeper = Keeper.of(process.url, "north", told.append)
        assert "nobody listens there" in told[0]
        keeper.patience_s = 0.1
        later = f"afkb store push {maps[0].folder} --prefix north --url {process.url}"
        with pytest.raises(EndpointError, match=f"send it later: {later}"):
            keeper.keep(maps[0].folder)
        process.start()
        assert keeper.keep(maps[0].folder).graph == "urn:afkb:map:north/kitchen"


def test_two_maps_of_one_name_are_not_sent_over_each_other(tmp_path):
    with pytest.raises(MapError, match="would both be kept as 'a'"):
        named([tmp_path / "x" / "a", tmp_path / "y" / "a"])
    assert list(named([tmp_path / "a"], prefix="north/")) == ["north/a"]
    with pytest.raises(MapError, match="is for one map"):
        named([tmp_path / "a", tmp_path / "b"], name="c")


def test_the_commands_send_list_and_remove(server, oxigraph, maps):
    from afkb.cli.app import build_cli
    from afkb.plugins.host import PluginHost

    cli = build_cli(PluginHost())

    def run(*arguments: str) -> str:
        done = CliRunner().invoke(cli, ["store", *arguments], env={"AFKB_STORE": oxigraph.url})
        assert done.exit_code == 0, done.output
        return done.stdout

    folders = [str(stored.folder) for stored in maps]
    assert "kitchen: stored" in run("push", *folders)
    assert "later: already there" in run("push", folders[1])
    assert "urn:afkb:map:later" in run("list")
    assert "later: removed" in run("remove", "later")
    assert [k.name for k in kept_maps(server)] == ["kitchen"]


def test_what_another_left_aside_unlisted_stops_no_push(server, maps):
    statements = [text for part in portions(statements_of(maps[0])) for text in part]
    staging = f"urn:afkb:staging:kitchen:{digest(maps[0])[:16]}"
    last = "\n".join(statements[-5:])
    server.update(f"INSERT DATA {{ GRAPH <{staging}> {{ {last} }} }}")
    assert push(server, maps[0], "kitchen").state is PushState.STORED
    assert kept(server, "kitchen") == digest(maps[0])
    assert staging not in graphs(server)
