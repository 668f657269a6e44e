"""The Robot@Home2 source, on a small database in its authors' schema, made here.

The real data are not at hand: what is held here is the layout as their toolbox reads it.
"""

from __future__ import annotations

import math
import sqlite3
from collections.abc import Sequence
from pathlib import Path

import cv2
import numpy as np
import pytest

from afkb.errors import SourceError
from afkb.flow import SkippedFrame, View
from afkb.plugins.protocols import Source
from afkb.testing import check_source
from afkb_robot_at_home import afkb_open_source

T0 = 1_400_000_000.0
OBSERVATION = (
    "id INTEGER, room_id INTEGER, home_session_id INTEGER, home_subsession_id INTEGER, "
    "home_id INTEGER, name TEXT, sensor_id INTEGER, sensor_pose_x REAL, sensor_pose_y REAL, "
    "sensor_pose_z REAL, sensor_pose_yaw REAL, sensor_pose_pitch REAL, sensor_pose_roll REAL, "
    "laser_aperture REAL, laser_max_range REAL, laser_num_of_scans INTEGER, time_stamp INTEGER"
)
SCHEMA = f"""
CREATE TABLE rh_homes (id INTEGER, name TEXT);
CREATE TABLE rh_rooms (id INTEGER, home_id INTEGER, name TEXT, room_type_id INTEGER);
CREATE TABLE rh_sensors (id INTEGER, sensor_type_id INTEGER, name TEXT);
CREATE TABLE rh_lblrgbd ({OBSERVATION});
CREATE TABLE rh_lsrscan ({OBSERVATION});
CREATE TABLE rh_lsrscan_scans (id INTEGER, shot_id INTEGER, scan REAL, valid_scan INTEGER,
    sensor_observation_id INTEGER);
CREATE TABLE rh2_old2new_rgbd_files (id INT, new_path TEXT, new_file_1 TEXT, new_file_2 TEXT);
INSERT INTO rh_homes VALUES (0, 'alma'), (1, 'anto');
INSERT INTO rh_rooms VALUES (0, 0, 'alma_kitchen1', 0), (1, 1, 'anto_bedroom1', 1);
INSERT INTO rh_sensors VALUES (0, 0, 'HOKUYO1'), (1, 1, 'RGBD_1');
"""
MOUNTED = (0.2, 0.1, 1.1, 0.0, 0.0, math.pi / 2)
"""On its side, as the robot's cameras are: x ahead, rolled by a right angle."""


def ticks(seconds: float) -> int:
    return round(seconds * 1e7) + 116_444_736_000_000_000


def row(at: int, t: float, pose: Sequence[float], sensor: int, home: int = 0) -> tuple[object, ...]:
    return (at, home, 0, 0, home, "", sensor, *pose, 4.0, 5.6, 5, ticks(t))


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Three upright images 0.5 s apart of a wall 2 m away, a scan 0.02 s after each."""
    images = tmp_path / "files" / "rgbd" / "session_1" / "alma"
    images.mkdir(parents=True)
    with sqlite3.connect(tmp_path / "rh.db") as db:
        db.executescript(SCHEMA)
        for k in range(3):
            t, at = T0 + 0.5 * k, 100_000 + k
            put(db, "rh_lblrgbd", row(at, t, MOUNTED, 1))
            put(db, "rh2_old2new_rgbd_files", (at, "session_1/alma", f"{at}_d.png", f"{at}_i.png"))
            pixels = np.full((320, 240), 2000, np.uint16)
            (images / f"{at}_d.png").write_bytes(cv2.imencode(".png", pixels)[1].tobytes())
            put(db, "rh_lsrscan", row(200_000 + k, t + 0.02, (0.3, 0, 0.2, 0, 0, 0), 0))
            for shot in range(5):
                put(db, "rh_lsrscan_scans", (5 * k + shot, shot, 3.0, shot % 4, 200_000 + k))
    poses = (f"{T0 - 1 + 0.1 * i:.2f} {0.1 * i - 1:.3f} 0 0 0 0 0 1" for i in range(40))
    (tmp_path / "robot.txt").write_text("\n".join(poses))
    return tmp_path


def put(db: sqlite3.Connection, table: str, values: Sequence[object]) -> None:
    db.execute(f"INSERT INTO {table} VALUES ({', '.join('?' * len(values))})", tuple(values))


def change(folder: Path, sql: str) -> None:
    with sqlite3.connect(folder / "rh.db") as db:
        db.executescript(sql)


def opened(folder: Path, **options: str) -> Source:
    source = afkb_open_source(str(folder), options, None)  # type: ignore[arg-type]
    assert source is not None
    return source


def with_trajectory(folder: Path, **options: str) -> Source:
    return opened(folder, trajectory=str(folder / "robot.txt"), **options)


def refusal(folder: Path, **options: str) -> str:
    with pytest.raises(SourceError) as refused:
        opened(folder, **options)
    assert "\n" not in str(refused.value)
    return str(refused.value)


def test_keeps_the_contract(folder: Path) -> None:
    check_source(with_trajectory(folder))


def test_robot_camera_and_laser_are_where_they_were(folder: Path) -> None:
    view = list(with_trajectory(folder).views())[1]
    assert isinstance(view, View)
    assert view.stamp == pytest.approx(T0 + 0.5)
    np.testing.assert_allclose(view.T_odom_base[:3, 3], [0.5, 0, 0], atol=1e-6)
    assert view.T_base_camera is not None
    np.testing.assert_allclose(view.T_base_camera[:3, 3], MOUNTED[:3])
    np.testing.assert_allclose(view.T_base_camera[:3, 2], [1, 0, 0], atol=1e-12)  # looks ahead
    np.testing.assert_allclose(view.T_base_camera[:3, 1], [0, 0, -1], atol=1e-12)  # image-down
    assert view.T_base_laser is not None  # the robot drove on for 0.02 s at 1 m/s
    np.testing.assert_allclose(view.T_base_laser[:3, 3], [0.32, 0, 0.2], atol=1e-6)
    assert view.scan is not None
    assert view.scan.hit.tolist() == [False, True, True, True, False]
    assert view.scan.angles.tolist() == [-2, -1, 0, 1, 2]
    assert view.camera is not None
    assert (view.camera.width, view.camera.fx, view.camera.fy) == (240, 271.36999, 286.441384)


def test_images_own_poses_serve_where_they_move(folder: Path) -> None:
    change(folder, "UPDATE rh_lblrgbd SET sensor_pose_x = id - 100000")
    source = opened(folder)
    check_source(source)
    views = [v for v in source.views() if isinstance(v, View)]
    assert [round(float(v.T_odom_base[0, 3]), 6) for v in views] == [0, 1, 2]
    assert not views[0].has_base
    assert views[0].scan is None
    assert "taken for the camera's" in getattr(source, "notes", ("",))[0]


def test_without_poses_of_the_robot_it_is_refused(folder: Path) -> None:
    assert "not where the robot was; give its poses as the option trajectory=" in refusal(folder)
    (folder / "none.txt").write_text("# nothing\n")
    assert "none.txt: no pose" in refusal(folder, trajectory=str(folder / "none.txt"))


def test_one_visit_is_chosen(folder: Path) -> None:
    with sqlite3.connect(folder / "rh.db") as db:
        put(db, "rh_lblrgbd", row(100_009, T0, MOUNTED, 1, home=1))
    refused = refusal(folder)
    assert "there is home=alma session=0, home=anto session=0" in refused
    assert len(with_trajectory(folder, home="alma")) == 3
    assert len(with_trajectory(folder, home="alma", room="kitchen1")) == 3
    assert "no image of RGBD_1" in refusal(folder, home="alma", room="attic")
    assert "no image of RGBD_9" in refusal(folder, home="alma", camera="RGBD_9")


def test_eight_bit_depth_is_skipped_with_its_reason(folder: Path) -> None:
    path = folder / "files/rgbd/session_1/alma/100001_d.png"
    path.write_bytes(cv2.imencode(".png", np.full((320, 240, 3), 90, np.uint8))[1].tobytes())
    frames = list(with_trajectory(folder).views())
    assert [type(f) for f in frames] == [View, SkippedFrame, View]
    assert isinstance(frames[1], SkippedFrame)
    assert "3 channels" in frames[1].why
    assert "observation 100001" in frames[1].where


def test_what_is_not_there_is_refused(folder: Path) -> None:
    (folder / "files").rename(folder / "elsewhere")
    assert "no files/rgbd; unpack the images" in refusal(folder)
    change(folder, "DROP TABLE rh_sensors")
    assert "no such table: rh_sensors; expected rh.db" in refusal(folder)
    (folder / "rh.db").write_bytes(b"no database at all, but long enough to be read as one" * 9)
    assert "is no Robot@Home2 database" in refusal(folder)


def test_other_files_are_left_to_other_sources(tmp_path: Path) -> None:
    for uri in (str(tmp_path), str(tmp_path / "rh.db"), __file__, "world:home"):
        assert afkb_open_source(uri, {}, None) is None  # type: ignore[arg-type]
