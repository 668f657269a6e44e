"""The same input gives the same map, byte for byte; only what tells of the run may differ."""

from pathlib import Path

from afkb.plugins.host import PluginHost
from afkb_mapping.run import make_map
from afkb_mapping.run_record import Settings

OF_THE_RUN = {"run.json", "timings.js"}


def content(folder: Path) -> dict[str, bytes]:
    files = [p for p in sorted(folder.rglob("*")) if p.is_file() and p.name not in OF_THE_RUN]
    return {str(p.relative_to(folder)): p.read_bytes() for p in files}


def test_two_runs_over_the_simulated_home_agree_in_every_byte(tmp_path):
    host = PluginHost()
    for name in ("first", "second"):
        make_map(host, Settings(uri="world:paper_home", out=tmp_path / name, stop=12))
    first, second = content(tmp_path / "first"), content(tmp_path / "second")
    assert {"scene.ttl", "map.json", "occupancy.pgm", "report.html"} <= first.keys()
    assert first == second


def test_stride_start_and_stop_choose_frames(tmp_path):
    settings = Settings(uri="world:paper_home", out=tmp_path / "map", start=2, stop=9, stride=3)
    result = make_map(PluginHost(), settings)
    assert result.run["frames"]["used"] == 3
    assert [round(float(row[0]), 3) for row in result.topological_map.trajectory] == sorted(
        round(float(row[0]), 3) for row in result.topological_map.trajectory
    )
