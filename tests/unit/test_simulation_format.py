"""World files: what is read, and what is refused with one line that says what to mend."""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml

from afkb.errors import SourceError
from afkb_simulation import afkb_open_source
from afkb_simulation.reading import bundled_worlds, read_world
from afkb_simulation.shapes import SHAPES
from afkb_simulation.source import open_world
from afkb_simulation.truth import load_truth

DOCS = Path(__file__).parents[2] / "docs" / "worlds.md"

SMALL = """
name: small
rooms: [{name: room, category: Office, rectangle: [0, 0, 4, 4]}]
things:
  - {name: table, shape: table, category: Table, at: [3, 2]}
  - {name: mug, shape: mug, category: Mug, on: table, at: [0.1, 0]}
tour: {waypoints: [{name: here, at: [1, 2], yaw_deg: 0}]}
"""


def _world(tmp_path: Path, text: str) -> str:
    path = tmp_path / "small.world.yaml"
    path.write_text(text, encoding="utf-8")
    return str(path)


def test_on_is_a_word_not_a_truth_value(tmp_path: Path) -> None:
    assert read_world(_world(tmp_path, SMALL)).things[1].on == "table"


def test_numbers_may_have_exponents(tmp_path: Path) -> None:
    text = SMALL.replace("at: [0.1, 0]", "at: [1e-1, -2.5E-2]")
    assert read_world(_world(tmp_path, text)).things[1].at == (0.1, -0.025)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("name: small\n", "", ": name: is missing"),
        ("shape: mug", "shape: mgu", "things[1] (mug): no shape 'mgu'; shapes: ball"),
        ("at: [0.1, 0]", "att: [0.1, 0]", "things[1] (mug).att: no such key"),
        ("at: [0.1, 0]", "at: [0.1]", "things[1] (mug).at"),
        ("at: [0.1, 0]", "at: [0.1, .nan]", "things[1] (mug).at[1]"),
        ("at: [0.1, 0]", "at: [5, 0]", "(mug).at: beyond the edge of 'table'"),
        ("at: [0.1, 0]", "at: [0, 0], level: 3", "(mug).level: a table has 1 surfaces"),
        ("at: [0.1, 0]", "size: [0, 1, 1]", "things[1] (mug).size[0]: input should be greater"),
        ("at: [0.1, 0]", "wall_m: 0.2", "leaves nothing hollow"),
        ("at: [0.1, 0]", "seat_m: 0.2", "a mug takes no seat_m"),
        ("at: [0.1, 0]", "yaw_deg: '90'", "things[1] (mug).yaw_deg: input should be a valid num"),
        ("at: [0.1, 0]", "present: {until: there}", "no waypoint 'there'; waypoints: here"),
        ("on: table", "on: desk", "(mug).on: no thing 'desk'"),
        ("on: table", "on: mug", "stands on itself"),
        ("shape: mug", "shape: mesh", "a mesh takes a `file`"),
        ("shape: mug", "shape: mug, file: mug.obj", "a mesh takes a `file`"),
        ("shape: mug", "shape: mesh, file: no.obj", "(mug).file: no mesh file"),
        ("at: [1, 2]", "at: [3, 2.1]", "runs into 'table' at (3.00, 2.10)"),
        ("at: [1, 2]", "at: [1, 1e9]", "at[1]: input should be less than or equal to 200"),
        ("name: mug", "name: table", "two are named 'table'"),
        ("at: [3, 2]", "at: [9, 2]", "things (table).at: in no room"),
        ("at: [1, 2]", "at: [9, 2]", "leaves the rooms at (9.00, 2.00)"),
        ("rectangle: [0, 0, 4, 4]", "polygon: [[0, 0], [1, 1]]", "at least three corners"),
        ("rectangle: [0, 0, 4, 4]", "polygon: []", "at least three corners"),
        ("rectangle: [0, 0, 4, 4]", "polygon: [[0, 0], [1, 1], [2, 2]]", "encloses no area"),
        ("things:", "sensor_noise: {range: [6, 1]}\nthings:", "nearest 6.0 is not below"),
        ("[0, 0, 4, 4]", "[0, 0, 4, 4], polygon: [[0, 0]]", "either a rectangle"),
        (
            "rectangle: [0, 0, 4, 4]",
            "polygon: [[0, 0], [4, 4], [4, 0], [0, 3]]",
            "the outline crosses itself",
        ),
        ("things:", "robot: {camera: null, laser: null}\nthings:", "both null"),
        (
            "things:",
            "doorways: [{between: [room, attic], at: [0, 2]}]\nthings:",
            "doorways[0].between: no room 'attic'; rooms: room",
        ),
        ("things:", "things: {", "line 5, column 3 not YAML"),
    ],
)
def test_what_is_wrong_is_said_in_one_line(tmp_path: Path, old: str, new: str, said: str) -> None:
    uri = _world(tmp_path, SMALL.replace(old, new, 1))
    with pytest.raises(SourceError) as caught:
        open_world(uri)
    message = str(caught.value)
    assert said in message
    assert message.startswith(uri)
    assert "\n" not in message


@pytest.mark.parametrize(
    "content",
    [
        b"\xff\xfe\x00",
        b"",
        b"- 1\n",
        b"42",
        b"&a {name: *a}",
        b"[" * 20000,
        b"name: 2020-99-99",
    ],
)
def test_what_is_no_world_is_refused(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "bad.world.yaml"
    path.write_bytes(content)
    with pytest.raises(SourceError, match="bad"):
        open_world(str(path))


def test_missing_files_and_unknown_names_are_refused(tmp_path: Path) -> None:
    with pytest.raises(SourceError, match="No such file"):
        open_world(str(tmp_path / "none.world.yaml"))
    with pytest.raises(SourceError, match=r"bundled: .*paper_home"):
        open_world("world:nowhere")


def test_options_other_than_a_seed_are_refused(tmp_path: Path) -> None:
    uri = _world(tmp_path, SMALL)
    with pytest.raises(SourceError, match="no option 'topic'"):
        open_world(uri, {"topic": "x"})
    with pytest.raises(SourceError, match="whole number"):
        open_world(uri, {"seed": "-1"})


def test_the_plugin_leaves_other_recordings_alone() -> None:
    for uri in ("folder", "x.bag", "world.yaml", "https://example.org/a.mcap"):
        assert afkb_open_source(uri=uri, options={}, knowledge_base=None) is None


def test_every_bundled_world_reads() -> None:
    assert "paper_home" in bundled_worlds()
    for name in bundled_worlds():
        assert len(open_world(f"world:{name}")) > 0


def test_the_documented_example_is_a_bundled_world_and_is_sensed() -> None:
    text = DOCS.read_text(encoding="utf-8").split("```yaml\n")[1].split("```")[0]
    uri = "world:two_rooms"
    assert bundled_worlds()["two_rooms"].read_text(encoding="utf-8") == text
    truth = load_truth(uri)
    assert truth.things["box"].on == "shelf"
    assert truth.rooms["hall"].area == pytest.approx(3.9 * 3 + 2)
    view = next(iter(open_world(uri).views()))
    assert (view.depth_m > 0).mean() > 0.9


def test_every_shape_is_documented_with_its_usual_size() -> None:
    text = DOCS.read_text(encoding="utf-8")
    for name, shape in SHAPES.items():
        assert f"| `{name}` | {', '.join(f'{v:g}' for v in shape.size)} |" in text


@pytest.mark.parametrize("shape", sorted(SHAPES))
def test_every_shape_has_the_size_it_says(tmp_path: Path, shape: str) -> None:
    data = yaml.safe_load(SMALL)
    data["things"] = [{"name": "it", "shape": shape, "category": "It", "at": [3, 2]}]
    it = load_truth(_world(tmp_path, yaml.safe_dump(data))).things["it"]
    said = SHAPES[shape].size
    extra = {"bed": (0, 0, 0.4), "mug": (0, 0.03, 0)}.get(shape, (0, 0, 0))
    for is_, size, more in zip(it.box.size_xyz, said, extra, strict=True):
        assert is_ == pytest.approx(size + more, abs=0.006)
    assert it.box.bottom == pytest.approx(0, abs=1e-9)
    assert 0 < it.top_height <= it.box.top + 1e-9
