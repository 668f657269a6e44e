"""Every kind of bad bag: a bad frame is skipped with its reason, a bad bag refused in one line."""

from __future__ import annotations

import shutil
import sqlite3
from pathlib import Path

import numpy as np
import pytest

from afkb.errors import SourceError
from afkb.flow import SkippedFrame, View
from afkb_rosbag import afkb_open_source
from bag_samples import (
    CAMERA_FRAME,
    HEIGHT,
    INFO,
    WIDTH,
    BagWriter,
    millimetres,
    open_bag,
    png,
    robot,
    wall,
)


def refusal(path: Path, **options: str) -> str:
    with pytest.raises(SourceError) as refused:
        open_bag(path, **options)
    assert "\n" not in str(refused.value)
    return str(refused.value)


def with_bad_frame(tmp_path: Path, bad: bytes, stated: str = "16UC1; compressedDepth") -> str:
    """Why the middle one of three frames is skipped when its data is `bad`."""
    bag = robot(BagWriter(), frames=3, depth=None)
    for k, data in enumerate([b"\0" * 12 + png(millimetres(wall())), bad, None]):
        good = b"\0" * 12 + png(millimetres(wall()))
        bag.compressed(1.0 + 0.2 * k, good if data is None else data, stated)
        bag.camera_info(1.0 + 0.2 * k)
    frames = list(open_bag(bag.write(tmp_path / "b")).views())
    assert [type(f) for f in frames] == [View, SkippedFrame, View]
    assert isinstance(frames[1], SkippedFrame)
    assert "/camera/depth/image_raw/compressedDepth at 1.200 s" in frames[1].where
    return frames[1].why


def test_truncated_png_is_skipped(tmp_path: Path) -> None:
    data = b"\0" * 12 + png(millimetres(wall()))
    assert "cut short" in with_bad_frame(tmp_path, data[:-30])


def test_damaged_png_is_skipped(tmp_path: Path) -> None:
    data = bytearray(b"\0" * 12 + png(millimetres(wall())))
    data[len(data) // 2] ^= 0xFF
    assert "damaged" in with_bad_frame(tmp_path, bytes(data))


@pytest.mark.parametrize(
    ("pixels", "why"),
    [
        (np.full((HEIGHT, WIDTH), 9, np.uint8), "8 bits"),
        (np.zeros((HEIGHT, WIDTH), np.uint16), "no valid pixel"),
        (np.full((HEIGHT, WIDTH), 65535, np.uint16), "no valid pixel"),
        (np.full((HEIGHT, WIDTH + 2), 900, np.uint16), "the camera says"),
    ],
)
def test_unusable_depth_is_skipped(tmp_path: Path, pixels: np.ndarray, why: str) -> None:
    assert why in with_bad_frame(tmp_path, b"\0" * 12 + png(pixels))


@pytest.mark.parametrize("data", [b"", b"short", b"\0" * 12 + b"no image at all"])
def test_data_that_is_no_png_is_skipped(tmp_path: Path, data: bytes) -> None:
    assert "compressedDepth" in with_bad_frame(tmp_path, data)


def test_first_image_that_is_damaged_does_not_hide_its_topic(tmp_path: Path) -> None:
    bag = robot(BagWriter(), frames=3)
    path = bag.write(tmp_path / "b", "sqlite3")
    with sqlite3.connect(path / "b.db3") as database:
        ids = "SELECT MIN(m.id) FROM messages m JOIN topics t ON m.topic_id = t.id"
        first = f"{ids} WHERE t.name = ?"
        (row,) = database.execute(first, ("/camera/depth/image_raw",)).fetchone()
        database.execute("UPDATE messages SET data = ? WHERE id = ?", (b"\0\1\0\0short", row))
    database.close()
    frames = list(open_bag(path).views())
    assert sum(isinstance(f, SkippedFrame) for f in frames) == 1
    assert sum(isinstance(f, View) for f in frames) == 2
    (skipped,) = (f for f in frames if isinstance(f, SkippedFrame))
    assert "does not decode" in skipped.why


def test_gap_in_tf_skips_the_frames_in_it(tmp_path: Path) -> None:
    bag = robot(BagWriter(), frames=12, odom=False)
    bag.messages = [m for m in bag.messages if m[1] != "/tf" or not 1.5 < m[0] / 1e9 < 2.5]
    frames = list(open_bag(bag.write(tmp_path / "b")).views())
    skipped = [f for f in frames if isinstance(f, SkippedFrame)]
    assert [f.index for f in skipped] == [3, 4, 5, 6, 7]
    assert "tf odom → base_link: no transform within 0.1 s" in skipped[0].why


def test_invalid_transform_counts_as_missing(tmp_path: Path) -> None:
    bag = robot(BagWriter(), frames=3, odom=False, tf=False)
    bag.tf(1.0, "odom", "base_link", (0, 0, 0))
    bag.tf(1.2, "odom", "base_link", (float("nan"), 0, 0))
    bag.tf(1.4, "odom", "base_link", (0, 0, 0), (0, 0, 0, 0))
    frames = list(open_bag(bag.write(tmp_path / "b")).views())
    assert [type(f) for f in frames] == [View, SkippedFrame, SkippedFrame]


def test_scan_without_beams_is_skipped(tmp_path: Path) -> None:
    bag = robot(BagWriter(), frames=2, depth=None, scan=False)
    bag.scan(1.0)
    bag.scan(1.2, beams=0)
    frames = list(open_bag(bag.write(tmp_path / "b")).views())
    assert [type(f) for f in frames] == [View, SkippedFrame]


def test_bag_without_camera_info_is_refused(tmp_path: Path) -> None:
    why = refusal(robot(BagWriter(), info=False).write(tmp_path / "b"))
    assert "no CameraInfo for /camera/depth/image_raw" in why
    assert INFO in why


def test_bag_with_zero_intrinsics_is_refused(tmp_path: Path) -> None:
    bag = robot(BagWriter(), info=False)
    bag.camera_info(1.0, f=0.0)
    why = refusal(bag.write(tmp_path / "b"))
    assert f"{INFO}: camera intrinsics {WIDTH}x{HEIGHT} fx=0.0" in why


def test_bag_without_depth_and_scan_is_refused(tmp_path: Path) -> None:
    why = refusal(robot(BagWriter(), depth=None, scan=False).write(tmp_path / "b"))
    assert "no depth image and no laser scan" in why
    assert "/odom (nav_msgs/msg/Odometry)" in why


def test_bag_without_poses_is_refused(tmp_path: Path) -> None:
    why = refusal(robot(BagWriter(), odom=False, tf=False).write(tmp_path / "b"))
    assert "no poses for 'base_link'" in why


def test_bag_without_a_chain_to_the_camera_is_refused(tmp_path: Path) -> None:
    why = refusal(robot(BagWriter(), statics=False).write(tmp_path / "b"))
    assert f"no tf leads from 'base_link' to the sensor frame '{CAMERA_FRAME}'" in why


@pytest.mark.parametrize("ending", ["bag", "mcap", "db3"])
def test_random_bytes_are_refused(tmp_path: Path, ending: str) -> None:
    path = tmp_path / f"noise.{ending}"
    path.write_bytes(np.random.default_rng(3).bytes(5000))
    assert f"noise.{ending}: not a readable bag" in refusal(path)
    path.write_bytes(b"")
    assert "not a readable bag" in refusal(path)


@pytest.mark.parametrize("storage", ["mcap", "sqlite3"])
def test_bag_cut_short_is_refused(tmp_path: Path, storage: str) -> None:
    folder = robot(BagWriter()).write(tmp_path / "b", storage)
    (file,) = (p for p in folder.iterdir() if p.suffix != ".yaml")
    file.write_bytes(file.read_bytes()[: file.stat().st_size // 2])
    assert "not a readable bag" in refusal(folder)


def test_folder_with_broken_metadata_is_refused(tmp_path: Path) -> None:
    folder = robot(BagWriter()).write(tmp_path / "b")
    (folder / "metadata.yaml").write_text("rosbag2_bagfile_information: [")
    assert "not a readable bag" in refusal(folder)


def test_folder_of_several_bags_without_metadata_is_refused(tmp_path: Path) -> None:
    folder = robot(BagWriter()).write(tmp_path / "b")
    (folder / "metadata.yaml").unlink()
    shutil.copy(folder / "b.mcap", folder / "c.mcap")
    assert "name one of them" in refusal(folder)


def test_options_are_checked(tmp_path: Path) -> None:
    path = robot(BagWriter()).write(tmp_path / "b")
    assert "unknown option 'dept_topic'" in refusal(path, dept_topic="/x")
    assert "depth_topic=/x: no such topic" in refusal(path, depth_topic="/x")
    assert "option max_dt='soon'" in refusal(path, max_dt="soon")
    assert "camera_info_topic=/x: no such topic" in refusal(path, camera_info_topic="/x")


def test_other_paths_are_left_to_other_sources(tmp_path: Path) -> None:
    (tmp_path / "notes.txt").write_text("nothing")
    for uri in (str(tmp_path), str(tmp_path / "notes.txt"), "world:home", str(tmp_path / "no.bag")):
        assert afkb_open_source(uri, {}, None) is None  # type: ignore[arg-type]
