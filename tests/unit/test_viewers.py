"""Who looks on while a map is made: a stranger's viewer, one that fails, and Rerun."""

from __future__ import annotations

import logging
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

from afkb.errors import PluginError
from afkb.plugins import hookimpl
from afkb.plugins.host import PluginHost
from afkb.testing import check_viewer, sample_detections, sample_view, sample_views
from afkb_mapping.crew import Crew
from afkb_mapping.exporting.export import export_map
from afkb_mapping.memory.memory import Memory
from afkb_mapping.memory.recollection import Recollection
from afkb_mapping.run_record import Stages
from afkb_mapping.viewing import Audience
from afkb_rerun.viewer import RerunViewer
from store_samples import sample_map


class Notebook:
    """Notes what it is shown; fails at the view that it is told to fail at."""

    name = "notebook"

    def __init__(self, fails_at: int | None = None) -> None:
        self.told: list[object] = []
        self.fails_at = fails_at

    def begin(self, uri: str, target: str | None) -> None:
        if target == "nowhere":
            raise PluginError("nowhere: not a place to show anything")
        self.told.append((uri, target))

    def show(self, view: object, detections: object) -> None:
        if view.index == self.fails_at:
            raise ZeroDivisionError("by zero")
        self.told.append((view.index, len(detections)))

    def end(self, topological_map: object) -> None:
        self.told.append(len(topological_map.entities))


def host_with(*viewers: object) -> PluginHost:
    class Plugin:
        @hookimpl
        def afkb_viewers(self, knowledge_base: object) -> list[object]:
            return list(viewers)

    host = PluginHost()
    host.register(Plugin(), name="notebook")
    return host


def test_a_strangers_viewer_is_begun_with_its_target() -> None:
    notebook = Notebook()
    audience = Audience.of(host_with(notebook), ["notebook=a=b"], "my-recording")
    audience.show(sample_view(), sample_detections())
    audience.end(sample_map())
    assert notebook.told == [("my-recording", "a=b"), (0, 5), 4]


def test_no_viewer_is_begun_unasked() -> None:
    notebook = Notebook()
    Audience.of(host_with(notebook), [], "my-recording").end(sample_map())
    assert notebook.told == []


def test_one_that_cant_begin_ends_the_run_before_it_begins() -> None:
    with pytest.raises(PluginError, match="not a place"):
        Audience.of(host_with(Notebook()), ["notebook=nowhere"], "x")
    with pytest.raises(PluginError, match="no viewer named 'film'"):
        Audience.of(host_with(), ["film"], "x")


def test_one_that_fails_is_named_and_left_out(caplog: pytest.LogCaptureFixture) -> None:
    failing, other = Notebook(fails_at=1), Notebook()
    audience = Audience([failing, other])
    with caplog.at_level(logging.WARNING):
        for view in (SimpleNamespace(index=i) for i in range(3)):
            audience.show(view, ())
    assert failing.told == [(0, 0)] and len(other.told) == 3
    assert "'notebook' failed with ZeroDivisionError" in caplog.text


def test_a_crew_shows_each_view_once_it_is_in_the_map() -> None:
    seen = Notebook()
    added: list[int] = []

    class Mapper:
        def add(self, view: object, detections: object, hypotheses: object) -> None:
            added.append(view.index)

    class Perceives:
        def detections(self, view: object) -> list[object]:
            return list(sample_detections())

    crew = Crew(
        *(Perceives(), [], Mapper, Stages(), Memory(), Recollection(()), None),
        Audience([seen]),
    )
    for view in sample_views():
        crew.take_in(view)
    assert seen.told == [(i, 5) for i in added] and len(added) == len(sample_views())


def read(path: Path) -> dict[str, list[str]]:
    """Entities of a Rerun recording, each with the timelines that it has data on."""
    chunk = pytest.importorskip("rerun.chunk")
    found: dict[str, list[str]] = {}
    for piece in chunk.RrdReader(path).stream().to_chunks():
        found[piece.entity_path] = list(piece.timeline_names)
    return found


def test_rerun_reads_the_whole_map_from_the_recording(tmp_path: Path) -> None:
    from afkb.store import write_map
    from afkb_nav2.exporter import Nav2Exporter
    from store_samples import Names

    pytest.importorskip("rerun")
    folder = write_map(tmp_path / "m", sample_map(), {}, [Nav2Exporter()], Names())
    (file,) = export_map(folder, "rerun", tmp_path / "home.rrd", host=host_with())
    found = read(file)
    things = {"/map/observed/n1", "/map/dynamic/n2", "/map/observed/n10", "/map/expected/n3"}
    assert things | {"/map/past/n4"} <= set(found)
    assert all("stamp" in found[thing] for thing in things)
    fixed = {"/map/grid", "/map/rooms", "/map/bounds", "/map/doorways", "/map/ways", "/map/places"}
    assert all(found[path] == [] for path in fixed)


def test_rerun_shows_views_and_the_finished_map_in_a_file(tmp_path: Path) -> None:
    pytest.importorskip("rerun")
    target = tmp_path / "live.rrd"
    check_viewer(RerunViewer(), sample_views(), target=str(target))
    found = read(target)
    assert {"/live/camera/image/depth", "/live/scan", "/live/robot", "/live/detections"} <= set(
        found
    )
    assert {"stamp", "view"} <= set(found["/live/robot"])
    assert {"/map/observed/thing-1", "/map/expected/thing-3"} <= set(found)
    with pytest.raises(PluginError, match="is there already"):
        RerunViewer().begin("x", str(target))
    with pytest.raises(PluginError, match=r"ends in \.rrd"):
        RerunViewer().begin("x", str(tmp_path / "film.mp4"))


@pytest.mark.parametrize(
    ("target", "what"),
    [
        ("rerun+http://127.0.0.1:1/proxy", "no viewer answers"),
        ("http://127.0.0.1:9876/proxy", r"write it as rerun\+http"),
        ("rerun+http://127.0.0.1:port/proxy", "not an address"),
        (None, "no display"),
    ],
)
def test_where_nothing_can_be_shown_is_told_in_one_line(
    target: str | None, what: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("rerun")
    monkeypatch.setattr(sys, "platform", "linux")
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    with pytest.raises(PluginError, match=what) as told:
        RerunViewer().begin("my-recording", target)
    assert "\n" not in str(told.value)


def test_without_reruns_package_one_line_says_how_to_get_it(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setitem(sys.modules, "rerun", None)
    with pytest.raises(PluginError, match=r"pip install .* '\.\[rerun\]'"):
        RerunViewer().begin("x", str(tmp_path / "x.rrd"))
    assert not list(tmp_path.iterdir())
