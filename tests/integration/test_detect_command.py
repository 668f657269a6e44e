"""`afkb detect`: what single frames give, as a table, as JSON and as pictures."""

import json

import cv2
import pytest
from typer.testing import CliRunner

from afkb.cli.app import build_cli
from afkb.plugins.host import PluginHost

pytestmark = pytest.mark.xdist_group("examples")


def detect(*arguments):
    return CliRunner().invoke(build_cli(PluginHost()), ["detect", *arguments])


@pytest.fixture(scope="module")
def seen(tmp_path_factory):
    folder = tmp_path_factory.mktemp("seen")
    arguments = ["world:two_rooms", "--frame", "1", "--count", "2"]
    result = detect(*arguments, "--json", "--pictures", str(folder / "pictures"))
    assert result.exit_code == 0, result.output
    return json.loads(result.stdout), folder / "pictures"


def test_json_tells_each_frame_with_what_its_things_may_be(seen) -> None:
    frames, _ = seen
    assert [f["frame"] for f in frames] == [1, 2]
    supports = [
        d for f in frames for d in f["detections"] if d["affords"].get("SupportAbility", 0) > 0.5
    ]
    floor = next(d for d in supports if d["measures"].get("is_floor"))
    assert floor["category"] == {"Floor": 1.0}
    for support in supports:
        assert support["scale"] in {"Small", "Medium", "Large"}
        assert support["movability"] in {"Static", "Dynamic"}
        assert 0 <= sum(support["category"].values()) <= 1.001


def test_pictures_show_the_frames(seen) -> None:
    _, pictures = seen
    assert sorted(p.name for p in pictures.iterdir()) == ["frame-000001.png", "frame-000002.png"]
    picture = cv2.imread(str(pictures / "frame-000001.png"))
    assert (picture[:, :, 0] != picture[:, :, 2]).any(), "nothing is drawn in colour"


def test_table_names_the_features() -> None:
    result = detect("world:two_rooms", "--detector", "surfaces")
    assert result.exit_code == 0, result.output
    assert "SupportAbility" in result.stdout


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["no-such-recording"], "no-such-recording"),
        (["world:two_rooms", "--frame", "9999"], "9999"),
        (["world:two_rooms", "--detector", "nothing"], "nothing"),
    ],
)
def test_bad_input_gets_one_line(arguments, said) -> None:
    result = detect(*arguments)
    assert result.exit_code == 1
    lines = [x for x in result.stderr.splitlines() if x]
    assert len(lines) == 1 and lines[0].startswith("error: ") and said in lines[0]
