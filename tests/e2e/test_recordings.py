"""What has to be seen on real and rendered recordings; skipped where they are absent."""

import json
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from afkb.flow import Entity, NodeKind, TopologicalMap
from afkb.plugins.host import PluginHost
from afkb.store import load, query
from afkb_mapping.geometry import T_from_xy_yaw
from afkb_mapping.run import RunResult, make_map
from afkb_mapping.run_record import Settings


@pytest.fixture(scope="session")
def host() -> PluginHost:
    return PluginHost()


def observed(found: TopologicalMap, feature: str) -> Iterator[Entity]:
    return (
        e
        for e in found.entities
        if e.kind is NodeKind.OBSERVED and e.affordances.get(feature, 0) >= 0.5
    )


@pytest.fixture(scope="session")
def kitchen(host, data_dir, tmp_path_factory) -> tuple[RunResult, Path]:
    out = tmp_path_factory.mktemp("redkitchen") / "map"
    settings = Settings(uri=str(data_dir / "redkitchen"), out=out, stride=8)
    return make_map(host, settings), out


@pytest.fixture(scope="session")
def merom(host, data_dir, tmp_path_factory) -> tuple[RunResult, dict]:
    home = data_dir / "homes" / "merom"
    out = tmp_path_factory.mktemp("merom") / "map"
    result = make_map(host, Settings(uri=str(home / "bag"), out=out))
    return result, json.loads((home / "truth.json").read_text())


@pytest.mark.xdist_group("redkitchen")
class TestRedkitchen:
    """A hand-held Kinect over a kitchen table, poses not gravity-aligned; truth by looking."""

    def test_one_table_top_of_its_height_and_size(self, kitchen):
        tables = [
            e
            for e in observed(kitchen[0].topological_map, "SupportAbility")
            if 0.6 < e.position_xyz[2] < 0.8
        ]
        (table,) = tables
        assert table.position_xyz[2] == pytest.approx(0.73, abs=0.03)
        assert 1.4 < table.size_xyz[0] < 2.6
        assert 0.7 < table.size_xyz[1] < 1.1

    def test_seats_and_counters_at_their_heights(self, kitchen):
        heights = [
            e.position_xyz[2] for e in observed(kitchen[0].topological_map, "SupportAbility")
        ]
        assert sum(0.40 < z < 0.50 for z in heights) >= 2
        assert sum(0.87 < z < 1.01 for z in heights) >= 2

    def test_both_mugs_and_the_box_are_single_containers_on_the_table(self, kitchen):
        found = kitchen[0].topological_map
        (table,) = [e for e in observed(found, "SupportAbility") if 0.6 < e.position_xyz[2] < 0.8]
        on_table = [e for e in observed(found, "ContainAbility") if e.supported_by == table.id]
        mugs = [e for e in on_table if max(e.size_xyz) < 0.2]
        assert len(mugs) == 2
        assert all(e.observations >= 3 for e in mugs)
        assert any("IntrinsicContainAbility" in e.affordances for e in on_table if e not in mugs)
        assert len(on_table) <= 4  # Magazines, books and the game controller are none.

    def test_the_room_is_a_kitchen(self, kitchen):
        (room,) = kitchen[0].topological_map.rooms
        assert max(room.belief, key=lambda name: room.belief[name]) == "Kitchen"

    def test_sparql_gives_the_containers_with_what_they_stand_on(self, kitchen, host):
        text = """SELECT ?thing ?support WHERE {
            ?thing afn:affords afn:ContainAbility ; afn:supportedBy ?support .
            ?support afn:affords afn:SupportAbility }"""
        result = query([load(kitchen[1])], text, host.knowledge_base.files)
        assert len(result.rows) >= 3


@pytest.mark.xdist_group("homes")
class TestHome:
    """A rendered tour with laser, depth and odometry that drifts; truth beside it."""

    def test_positions_hold_throughout(self, merom):
        result, truth = merom
        first = truth["views"][0]
        T_world_map = T_from_xy_yaw(first["x"], first["y"], first["yaw"])
        true = {round(v["stamp"], 3): (v["x"], v["y"]) for v in truth["views"]}
        errors = []
        for row in result.topological_map.trajectory:
            x, y = (T_world_map @ row[1:].reshape(4, 4))[:2, 3]
            errors.append(np.hypot(x - true[round(row[0], 3)][0], y - true[round(row[0], 3)][1]))
        assert len(errors) == len(truth["views"])
        assert max(errors) < 0.06

    def test_tables_beds_counters_and_seats_are_single_nodes(self, merom):
        result, truth = merom
        first = truth["views"][0]
        T_map_world = np.linalg.inv(T_from_xy_yaw(first["x"], first["y"], first["yaw"]))
        supports = list(observed(result.topological_map, "SupportAbility"))
        wanted = {"table", "coffee_table", "bed", "chair", "stool"}
        for thing in truth["things"]:
            if thing["category"] not in wanted or thing["top_pixels"] < 3000:
                continue
            low, high = np.array(thing["min"]), np.array(thing["max"])
            x, y, *_ = T_map_world @ [*((low + high) / 2)[:2], 0, 1]
            near = [
                e
                for e in supports
                if np.hypot(e.position_xyz[0] - x, e.position_xyz[1] - y) < 0.15
                and abs(e.position_xyz[2] - thing["top_height"]) < 0.05
            ]
            assert len(near) == 1, thing["name"]


@pytest.mark.xdist_group("homes")
def test_memory_and_rate_are_recorded_and_bounded(data_dir, tmp_path):
    """In a process of its own, since the peak is that of all that a process has done."""
    bag = data_dir / "homes" / "merom" / "bag"
    command = ["map", str(bag), "--out", str(tmp_path / "map"), "--stop", "60", "--json"]
    done = subprocess.run(
        [sys.executable, "-c", "from afkb.cli.app import main; main()", *command],
        capture_output=True,
        text=True,
        check=True,
    )
    run = json.loads(done.stdout)
    assert run["peak_memory_mb"] < 1000
    assert run["frames_per_second"] > 0
    assert {"read", "register", "map"} <= run["seconds"].keys()


def test_a_laser_log_gives_grid_and_rooms_without_affordances(host, data_dir, tmp_path):
    log = data_dir / "lasers" / "intel.log"
    result = make_map(host, Settings(uri=str(log), out=tmp_path / "map", stop=150))
    found = result.topological_map
    assert not found.entities
    assert found.rooms
    assert found.bounds
    assert any("no depth" in note for note in found.notes)
    assert np.nansum(found.grid.probability < 0.3) * 0.05**2 > 50
