"""What weighs exports counts what is there."""

from __future__ import annotations

from argparse import Namespace
from pathlib import Path

import pytest

from afkb.plugins.host import PluginHost
from afkb.store import write_map
from afkb_mapping.exporting.export import export_map
from afkb_nav2.exporter import Nav2Exporter
from bench.exports import formats, peers
from store_samples import Names, sample_map


def test_formats_and_peers_are_weighed_and_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    some = [f for f in formats.formats(PluginHost()) if f.name in ("graphml", "nav2", "paper")]
    monkeypatch.setattr(formats, "formats", lambda host: some)
    folder = write_map(tmp_path / "home", sample_map(), {}, [Nav2Exporter()], Names())
    args = Namespace(maps=[folder], repeats=1)
    weighed = formats.run(args)["home"]
    (graph,) = export_map(folder, "graphml", tmp_path / "x.graphml")
    assert weighed["nodes"] == 10 and weighed["graphml"]["bytes"] == graph.stat().st_size
    assert weighed["nav2"]["read"]["median_ms"] > 0 and weighed["paper"]["read"] is None
    beside = peers.run(args)["home"]
    assert beside["nodes in both"] == 8
    assert beside["map.json"]["bytes"] == (folder / "map.json").stat().st_size
    lines = [*formats.table({"home": weighed}), *peers.table({"home": beside})]
    assert sum("graphml" in line for line in lines) == 1 and len(lines) == 5 + 8
