"""The drawing that the page of `afkb serve` and report.html share."""

import json
import re
from dataclasses import replace
from xml.etree import ElementTree

import numpy as np
import pytest

from afkb.drawing import (
    asset,
    asset_names,
    drawing_of,
    drawing_of_stored,
    inline_script,
    inline_style,
)
from afkb.store import load, write_map
from afkb_nav2.exporter import Nav2Exporter
from store_samples import Names, pose_row, sample_map


def test_a_map_read_back_is_drawn_as_the_one_that_was_written(tmp_path) -> None:
    folder = write_map(tmp_path / "home", sample_map(), {}, [Nav2Exporter()], Names())
    stored = drawing_of_stored(load(folder))
    made = drawing_of(sample_map())
    assert stored["name"] == "home"
    assert stored["summary"] == made.summary
    assert stored["nodes"].keys() == made.nodes.keys()
    assert stored["nodes"]["n2"] == made.nodes["n2"]
    assert json.dumps(stored, allow_nan=False)
    ids = [
        re.findall(r'class="node [^"]*" data-id="(\w+)"', svg) for svg in (stored["svg"], made.svg)
    ]
    assert sorted(ids[0]) == sorted(ids[1]) == ["n1", "n10", "n2", "n3", "n4"]


def test_the_plan_needs_no_inline_style_or_script() -> None:
    plan = ElementTree.fromstring(drawing_of(sample_map()).svg)
    for drawn in plan.iter():
        assert drawn.tag != "script"
        assert not {key for key in drawn.attrib if key == "style" or key.startswith("on")}


def test_edges_name_their_ends_so_that_they_come_and_go_with_them() -> None:
    plan = ElementTree.fromstring(drawing_of(sample_map()).svg)
    ends = {e.get("data-id"): e.get("data-ends") for e in plan.iter() if e.get("data-ends")}
    assert ends == {"e1": "p1 p2", "e2": "p2 n1", "e3": "p1 b1"}


def test_times_tell_visits_apart_and_thin_the_way() -> None:
    way = [pose_row(0, 0, 0), pose_row(1, 0.01, 0), pose_row(2, 1, 0), pose_row(9000, 2, 0)]
    time = drawing_of(replace(sample_map(), trajectory=np.array(way))).times
    assert time["visits"] == [[0.0, 9.25], [9000.0, 9000.0]]
    assert time["way"] == [[0.0, 0.0, 0.0], [2.0, 1.0, 0.0], [9000.0, 2.0, 0.0]]


def test_past_predictions_tell_what_came_of_them() -> None:
    told = drawing_of(sample_map()).nodes["n4"]
    assert (told["state"], told["seen_as"], told["ended"]) == ("Confirmed", "n1", 9.25)
    assert [step["kind"] for step in told["steps"]] == ["Predicted", "Confirmed"]


@pytest.mark.parametrize(
    "name", ["../plan.py", "page.css/../../plan.py", "", "nothing.js", "/etc/passwd"]
)
def test_only_the_pages_own_files_are_handed_out(name: str) -> None:
    with pytest.raises(KeyError):
        asset(name)


def test_a_served_page_has_nothing_inline_and_names_no_other_place() -> None:
    for name in asset_names():
        content, media = asset(name)
        text = content.decode()
        assert media.endswith("charset=utf-8")
        assert set(re.findall(r"https?://[^\"'` ]+", text)) <= {"http://www.w3.org/2000/svg"}
        assert not re.search(r"<script>|<style>| style=| on\w+=\"", text), name
        assert "innerHTML" not in text


def test_modules_that_are_joined_name_nothing_twice() -> None:
    script = inline_script("report.js")
    names = re.findall(r"^(?:const|let|class|(?:async )?function) (\w+)", script, re.MULTILINE)
    assert len(names) == len(set(names))
    assert "import " not in script.replace("important", "")
    assert "</script" not in script
    assert "</style" not in inline_style()
