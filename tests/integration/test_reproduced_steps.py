"""The sheet of a scenario shows the map as it stood, step by step."""

from __future__ import annotations

from pathlib import Path

from afkb.flow import NodeKind
from afkb.plugins.host import PluginHost
from afkb_paper.panels import Camera, Frame, graph_panel, grid_panel
from afkb_paper.steps import Steps

EARLY_S = 2.5


def test_the_hidden_table_is_drawn_hollow_before_it_is_seen(demo_folder: Path) -> None:
    host = PluginHost()
    steps = Steps.of(demo_folder / "demo-map", host)
    then = steps.until(EARLY_S)
    assert NodeKind.DUAL in {e.kind for e in then.entities}
    assert NodeKind.DUAL not in {e.kind for e in steps.until(EARLY_S, predicting=False).entities}
    assert then.trajectory[:, 0].max() <= EARLY_S
    frame = Frame.around(then)
    assert 'class="thing table expected' in graph_panel(then, frame)
    assert "data:image/png" in grid_panel(then, frame)
    seen = steps.view_at(then.places[0], 0.0, EARLY_S)
    assert seen is not None
    picture = Camera.of(host, "world:paper_home").picture(seen.view.index, seen.T_map_base)
    assert picture.startswith('<img src="data:image/jpeg;base64,')
