"""The bag source on real recordings, and on bags that rosbags' own writers made."""

from __future__ import annotations

import json
import sqlite3
import tracemalloc
from pathlib import Path

import numpy as np
import pytest

from afkb.flow import View
from afkb.testing import check_source
from afkb_rosbag.topics import camera_info_beside
from bag_samples import (
    CAMERA_FRAME,
    HEIGHT,
    WIDTH,
    BagWriter,
    all_views,
    millimetres,
    open_bag,
    put_depth,
    robot,
    wall,
)


@pytest.fixture(scope="module")
def home(data_dir: Path) -> Path:
    return data_dir / "homes" / "pomaria"


def test_recorded_home_keeps_the_contract(home: Path) -> None:
    check_source(open_bag(home / "bag"), at_most=3)


def test_recorded_home_has_everything_a_view_can_have(home: Path) -> None:
    truth = json.loads((home / "truth.json").read_text())
    source = open_bag(home / "bag")
    assert len(source) == truth["frames"]
    assert source.gravity_aligned
    (view,) = source.views(3, 4)
    assert isinstance(view, View)
    assert view.index == 3
    assert view.camera is not None
    assert view.camera.fx == 525
    assert view.T_base_camera is not None
    assert view.T_base_camera[2, 3] == pytest.approx(1.15)  # the README: camera 1.15 m up
    assert view.T_base_laser is not None
    assert view.scan is not None
    assert view.scan.ranges_m.size == 720
    assert view.has_base


def test_recorded_poses_are_the_odometry_that_was_recorded(home: Path) -> None:
    truth = json.loads((home / "truth.json").read_text())["views"]
    source = open_bag(home / "bag", depth_topic="none")
    for view, true in zip(all_views(source), truth, strict=True):
        x, y, yaw = true["odom"]
        assert view.stamp == pytest.approx(true["stamp"])
        np.testing.assert_allclose(view.T_odom_base[:2, 3], [x, y], atol=1e-3)
        np.testing.assert_allclose(view.T_odom_base[:2, 0], [np.cos(yaw), np.sin(yaw)], atol=1e-3)


def test_bare_mcap_reads_like_its_folder(home: Path) -> None:
    bare = open_bag(home / "bag" / "bag.mcap")
    (a,), (b,) = bare.views(5, 6), open_bag(home / "bag").views(5, 6)
    assert isinstance(a, View)
    assert isinstance(b, View)
    np.testing.assert_array_equal(a.depth_m, b.depth_m)
    np.testing.assert_array_equal(a.T_odom_base, b.T_odom_base)


@pytest.mark.parametrize("storage", ["mcap", "sqlite3"])
@pytest.mark.parametrize("kind", ["16UC1", "32FC1", "compressed16", "compressed32"])
def test_depth_in_every_form_means_the_same_metres(tmp_path: Path, storage: str, kind: str) -> None:
    source = open_bag(robot(BagWriter(), depth=kind).write(tmp_path / "b", storage))
    views = all_views(source)
    assert len(views) == len(source) == 6
    for k, view in enumerate(views):
        assert view.depth_m is not None
        expected = wall(2 + 0.1 * k)
        # quantisation of 1 / depth: half a step of depth² / A, with A = 100 · 101
        tolerance = 1e-3 if kind != "compressed32" else 1.1 * float(expected.max()) ** 2 / 10100
        np.testing.assert_allclose(view.depth_m, expected, atol=tolerance)
        assert view.depth_m[0, 0] == 0


def test_ros1_bag_reads_like_the_ros2_one(tmp_path: Path) -> None:
    one = all_views(open_bag(robot(BagWriter(ros1=True)).write(tmp_path / "one.bag")))
    two = all_views(open_bag(robot(BagWriter()).write(tmp_path / "two")))
    for a, b in zip(one, two, strict=True):
        assert a.stamp == b.stamp
        np.testing.assert_array_equal(a.depth_m, b.depth_m)
        np.testing.assert_allclose(a.T_odom_base, b.T_odom_base)
        assert a.scan is not None
        assert b.scan is not None
        np.testing.assert_array_equal(a.scan.ranges_m, b.scan.ranges_m)


def test_frame_names_with_a_slash_are_those_without(tmp_path: Path) -> None:
    """Old ROS 1 writes `/base_link` here and `base_link` there, in `tf/tfMessage`."""
    bag = robot(BagWriter(ros1=True, tf_type="tf/msg/tfMessage"), odom=False)
    for _, topic, _, message in bag.messages:
        if topic == "/tf":
            message.transforms[0].header.frame_id = "/odom"
            message.transforms[0].child_frame_id = "/base_link"
    views = all_views(open_bag(bag.write(tmp_path / "old.bag")))
    assert views[5].T_odom_base[0, 3] == pytest.approx(0.5)


def test_bag_without_message_definitions_opens(tmp_path: Path) -> None:
    """Before ROS 2 Iron, sqlite3 bags held none."""
    folder = robot(BagWriter()).write(tmp_path / "b", "sqlite3")
    with sqlite3.connect(folder / "b.db3") as database:
        database.execute("DELETE FROM message_definitions")
    database.close()
    assert len(all_views(open_bag(folder))) == 6


def test_folder_of_one_bag_file_opens(tmp_path: Path) -> None:
    bag = robot(BagWriter()).write(tmp_path / "b")
    (bag / "metadata.yaml").unlink()
    assert len(open_bag(bag)) == 6


def test_chain_of_transforms_is_composed(tmp_path: Path) -> None:
    """base_link → mast (1 m up) → camera (0.1 m ahead, optical): links multiply in that order."""
    view = all_views(open_bag(robot(BagWriter()).write(tmp_path / "b")))[2]
    assert view.T_base_camera is not None
    np.testing.assert_allclose(view.T_base_camera[:3, 3], [0.1, 0, 1.0], atol=1e-9)
    np.testing.assert_allclose(view.T_base_camera[:3, 2], [1, 0, 0], atol=1e-9)  # looks ahead
    np.testing.assert_allclose(view.T_odom_base[:3, 3], [0.2, 0, 0], atol=1e-9)


def test_poses_between_two_transforms_are_interpolated(tmp_path: Path) -> None:
    bag = robot(BagWriter(), frames=1, odom=False, tf=False)
    half = np.pi / 8
    bag.tf(0.9, "odom", "base_link", (0, 0, 0))
    bag.tf(1.1, "odom", "base_link", (1, 0, 0), (0, 0, np.sin(half), np.cos(half)))
    (view,) = all_views(open_bag(bag.write(tmp_path / "b")))
    assert view.T_odom_base[0, 3] == pytest.approx(0.5)
    assert np.arctan2(view.T_odom_base[1, 0], view.T_odom_base[0, 0]) == pytest.approx(np.pi / 8)


def test_odometry_topic_serves_where_tf_has_no_motion(tmp_path: Path) -> None:
    views = all_views(open_bag(robot(BagWriter(), tf=False).write(tmp_path / "b")))
    assert [round(v.T_odom_base[0, 3], 6) for v in views] == [0, 0.1, 0.2, 0.3, 0.4, 0.5]


def test_chosen_odometry_topic_comes_before_tf(tmp_path: Path) -> None:
    bag = robot(BagWriter(), odom=False)
    for k in range(6):
        bag.odometry(1.0 + 0.2 * k, 7.0)
    path = bag.write(tmp_path / "b")
    assert all_views(open_bag(path))[5].T_odom_base[0, 3] == pytest.approx(0.5)
    assert all_views(open_bag(path, odom_topic="/odom"))[5].T_odom_base[0, 3] == pytest.approx(7)


def test_odometry_of_a_frame_that_tf_lacks_moves_the_usual_base(tmp_path: Path) -> None:
    bag = robot(BagWriter(), odom=False, tf=False)
    for k in range(6):
        bag.odometry(1.0 + 0.2 * k, 0.1 * k, child="chassis")
    view = all_views(open_bag(bag.write(tmp_path / "b")))[5]
    assert view.T_odom_base[0, 3] == pytest.approx(0.5)
    assert view.T_base_camera is not None
    assert view.T_base_camera[2, 3] == pytest.approx(1.0)


def test_chosen_odom_frame_takes_corrected_poses(tmp_path: Path) -> None:
    bag = robot(BagWriter())
    for k in range(6):
        bag.tf(1.0 + 0.2 * k, "map", "odom", (0, 5, 0))
    source = open_bag(bag.write(tmp_path / "b"), odom_frame="map")
    assert all_views(source)[5].T_odom_base[1, 3] == pytest.approx(5)


def test_hand_held_camera_has_its_body_for_a_base(tmp_path: Path) -> None:
    bag = robot(BagWriter(), scan=False, odom=False, tf=False, statics=False)
    for k in range(6):
        bag.tf(1.0 + 0.2 * k, "world", CAMERA_FRAME, (0, 0, k), (-0.5, 0.5, -0.5, 0.5))
    source = open_bag(bag.write(tmp_path / "b"))
    view = all_views(source)[2]
    assert not view.has_base
    assert not source.gravity_aligned
    np.testing.assert_allclose(view.T_odom_base[:3, :3], np.eye(3), atol=1e-9)
    assert view.T_odom_base[2, 3] == pytest.approx(2)


def test_scan_taken_later_is_placed_where_the_laser_was_then(tmp_path: Path) -> None:
    bag = robot(BagWriter(), frames=2, scan=False)
    bag.scan(1.05)  # the robot drives 0.5 m/s
    first = all_views(open_bag(bag.write(tmp_path / "b")))[0]
    assert first.T_base_laser is not None
    assert first.T_base_laser[0, 3] == pytest.approx(0.2 + 0.05 * 0.5)


def test_scan_too_far_in_time_is_left_out(tmp_path: Path) -> None:
    bag = robot(BagWriter(), frames=2, scan=False)
    bag.scan(1.0)
    first, second = all_views(open_bag(bag.write(tmp_path / "b")))
    assert first.scan is not None
    assert second.scan is None


def test_messages_recorded_late_find_their_frame(tmp_path: Path) -> None:
    bag = robot(BagWriter(), scan=False)
    for k in range(6):
        bag.scan(1.0 + 0.2 * k, delay=0.5)
    source = open_bag(bag.write(tmp_path / "b"))
    assert all(v.scan is not None for v in all_views(source))
    (third,) = source.views(3, 4)
    assert isinstance(third, View)
    assert third.scan is not None


def test_laser_only_bag_gives_views_without_depth(tmp_path: Path) -> None:
    views = all_views(open_bag(robot(BagWriter(), depth=None).write(tmp_path / "b")))
    assert len(views) == 6
    assert all(v.depth_m is None and v.scan is not None for v in views)


def test_sensors_can_be_left_out(tmp_path: Path) -> None:
    path = robot(BagWriter()).write(tmp_path / "b")
    assert all(v.scan is None for v in all_views(open_bag(path, scan_topic="none")))
    assert all(v.depth_m is None for v in all_views(open_bag(path, depth_topic="none")))


def test_colour_and_infrared_images_are_not_taken_for_depth(tmp_path: Path) -> None:
    bag = robot(BagWriter())
    for k in range(20):
        t = 1.0 + 0.05 * k
        bag.image(t, np.zeros((HEIGHT, WIDTH, 3), np.uint8), "rgb8", "/camera/color/image_raw")
        bag.image(t, np.ones((HEIGHT, WIDTH), np.uint16), "mono16", "/camera/ir/image_raw")
    source = open_bag(bag.write(tmp_path / "b"))
    assert len(source) == 6
    assert len(all_views(source)) == 6


def test_unset_stamps_fall_back_to_time_of_recording(tmp_path: Path) -> None:
    bag = robot(BagWriter(), frames=3)
    for _, _, kind, message in bag.messages:
        if kind == "sensor_msgs/msg/Image":
            message.header.stamp.sec = message.header.stamp.nanosec = 0
    stamps = [v.stamp for v in all_views(open_bag(bag.write(tmp_path / "b")))]
    assert stamps == pytest.approx([1.0, 1.2, 1.4])


def test_big_endian_images_are_read(tmp_path: Path) -> None:
    bag = robot(BagWriter(), frames=1, depth=None)
    bag.image(1.0, millimetres(wall()).astype(">u2"), "16UC1")
    bag.camera_info(1.0)
    (view,) = all_views(open_bag(bag.write(tmp_path / "b")))
    assert view.depth_m is not None
    np.testing.assert_allclose(view.depth_m, wall(), atol=1e-3)


def test_slices_keep_index_and_content(tmp_path: Path) -> None:
    source = open_bag(robot(BagWriter(), frames=9).write(tmp_path / "b"))
    whole = all_views(source)
    part = list(source.views(2, 8, 3))
    assert [f.index for f in part] == [2, 5]
    for frame in part:
        assert isinstance(frame, View)
        np.testing.assert_array_equal(frame.depth_m, whole[frame.index].depth_m)
    assert list(source.views(20)) == []


def test_memory_does_not_grow_with_the_recording(tmp_path: Path) -> None:
    """Four times the frames, each of 150 kB: the peak stays that of a few frames."""
    peaks = []
    for frames in (25, 100):
        path = tmp_path / f"b{frames}"
        big_recording(frames).write(path)
        all_of_it = iter(open_bag(path).views())
        next(all_of_it)
        tracemalloc.start()
        assert sum(isinstance(f, View) for f in all_of_it) == frames - 1
        peaks.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()
    assert peaks[1] < 1.2 * peaks[0]
    assert peaks[1] < 50 * 150_000


def big_recording(frames: int) -> BagWriter:
    bag = BagWriter()
    pixels = np.random.default_rng(0).integers(500, 4000, (240, 320)).astype(np.uint16)
    bag.tf(1.0, "base_link", CAMERA_FRAME, static=True)
    bag.camera_info(1.0)
    info = bag.messages[-1][3]
    info.width, info.height = 320, 240
    for k in range(frames):
        bag.image(1.0 + 0.1 * k, pixels, "16UC1")
        bag.tf(1.0 + 0.1 * k, "odom", "base_link", (0.1 * k, 0, 0))
    return bag


@pytest.mark.parametrize(
    ("topic", "info"),
    [
        ("/camera/depth/image_raw", "/camera/depth/camera_info"),
        ("/camera/depth/image_raw/compressedDepth", "/camera/depth/camera_info"),
        ("/depth_registered/image", "/depth_registered/camera_info"),
    ],
)
def test_camera_info_lies_beside_its_image(topic: str, info: str) -> None:
    assert camera_info_beside(topic) == info


def test_depth_and_its_compressed_copy_are_one_camera(tmp_path: Path) -> None:
    bag = robot(BagWriter())
    for k in range(6):
        put_depth(bag, 1.0 + 0.2 * k, wall(), "compressed16")
    assert len(all_views(open_bag(bag.write(tmp_path / "b")))) == 6
