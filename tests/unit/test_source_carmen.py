"""The CARMEN source: the recorded laboratory, lines taken apart and put together, bad lines."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from afkb.errors import BadFrame, SourceError
from afkb.flow import SkippedFrame, View
from afkb.plugins.protocols import Source
from afkb.testing import check_source
from afkb_carmen import afkb_open_source
from afkb_carmen.lines import Pose, compose, invert, parse_odometry, parse_scan

Numbers = tuple[float, ...]


def flaser(ranges: Numbers, laser: Numbers, robot: Numbers, stamp: float) -> str:
    words = [len(ranges), *map(repr, (*ranges, *laser, *robot, stamp)), "robot", repr(stamp)]
    return " ".join(["FLASER", *map(str, words)])


def odom(robot: Numbers, stamp: float) -> str:
    return " ".join(["ODOM", *map(repr, (*robot, 0.0, 0.0, 0.0, stamp)), "robot", repr(stamp)])


def straight(k: int, beams: int = 5) -> str:
    """The scan at second k of a drive along x at 1 m/s, with the laser 0.1 m ahead of the base."""
    return flaser((2.0,) * beams, (k + 0.1, 0.0, 0.0), (float(k), 0.0, 0.0), float(k))


def log(tmp_path: Path, *lines: str) -> Path:
    path = tmp_path / "drive.log"
    path.write_text("# CARMEN Logfile\nPARAM robot_width 0.5 nohost 0\n" + "\n".join(lines) + "\n")
    return path


def open_log(path: Path, **options: str) -> Source:
    source = afkb_open_source(str(path), options, None)  # type: ignore[arg-type]
    assert source is not None
    return source


def all_views(source: Source) -> list[View]:
    frames = list(source.views())
    assert all(isinstance(f, View) for f in frames), frames
    return [f for f in frames if isinstance(f, View)]


def test_recorded_laboratory_keeps_the_contract(data_dir: Path) -> None:
    check_source(open_log(data_dir / "lasers" / "intel.log"), at_most=50)


def test_recorded_laboratory_is_laser_only(data_dir: Path) -> None:
    views = all_views(open_log(data_dir / "lasers" / "intel.log"))
    assert len(views) == 910
    assert all(v.depth_m is None and v.scan is not None for v in views)
    first = views[0]
    assert first.stamp == pytest.approx(32.9068)
    np.testing.assert_allclose(first.T_odom_base[:2, 3], [0.600266, -0.0320327])
    assert first.scan is not None
    assert first.scan.ranges_m.size == 180
    assert first.scan.angle_min == pytest.approx(-math.pi / 2)
    assert first.scan.angle_increment == pytest.approx(math.radians(1))
    stamps = [v.stamp for v in views]
    assert stamps == sorted(stamps)


def test_recorded_beams_without_return_are_none(data_dir: Path) -> None:
    """The laser wrote 81.83 m 4,172 times: an error code of the SICK, in cm."""
    views = all_views(open_log(data_dir / "lasers" / "intel.log"))
    missed = sum(int((~v.scan.hit).sum()) for v in views if v.scan is not None)
    assert missed >= 4172
    longest = max(float(v.scan.ranges_m[v.scan.hit].max()) for v in views if v.scan is not None)
    assert longest < 80


def test_raw_odometry_drifts_where_the_mapper_s_does_not(data_dir: Path) -> None:
    """The robot ends where it began; ODOM steps alone lead elsewhere."""
    path = data_dir / "lasers" / "intel.log"
    given_poses, raw = open_log(path), open_log(path, poses="odom")
    ends = [next(s.views(909)) for s in (given_poses, raw)]
    near, far = (np.hypot(*v.T_odom_base[:2, 3]) for v in ends if isinstance(v, View))
    assert near < 1
    assert far > 10


def test_laser_sits_where_its_poses_differ_from_the_robot_s(tmp_path: Path) -> None:
    lines = [
        flaser((2.0,) * 5, tuple(compose(robot, Pose(0.3, 0.05, 0.1))), tuple(robot), 1.0)
        for robot in (Pose(0, 0, 0), Pose(1, 2, 1.5), Pose(-3, 1, -2))
    ]
    for view in all_views(open_log(log(tmp_path, *lines))):
        assert view.T_base_laser is not None
        np.testing.assert_allclose(view.T_base_laser[:2, 3], [0.3, 0.05], atol=1e-5)
        assert math.atan2(*view.T_base_laser[1::-1, 0]) == pytest.approx(0.1, abs=1e-5)


def test_corrected_poses_are_not_taken_for_the_laser_s_place(tmp_path: Path) -> None:
    lines = [flaser((2.0,) * 5, (1.2 * k, 0.4 * k, 0), (k, 0, 0), float(k)) for k in range(4)]
    for view in all_views(open_log(log(tmp_path, *lines))):
        assert view.T_base_laser is not None
        np.testing.assert_array_equal(view.T_base_laser, np.eye(4))


def test_odometry_steps_add_up_without_the_mapper_s_jumps(tmp_path: Path) -> None:
    """The scan has the last ODOM's stamp and another pose: the jump between is no motion."""
    path = log(
        tmp_path,
        odom((0, 0, 0), 1.0), odom((1, 0, 0), 2.0),
        flaser((2.0,) * 5, (5, 5, 0), (5, 5, 0), 2.0),
        odom((6, 5, 0), 3.0), "ODOM 7 5", odom((8, 5, 0), 4.0),
        flaser((2.0,) * 5, (8, 5, 0), (8, 5, 0), 4.0),
    )  # fmt: skip
    xs = [float(v.T_odom_base[0, 3]) for v in all_views(open_log(path, poses="odom"))]
    assert xs == pytest.approx([1, 4])
    assert [float(v.T_odom_base[0, 3]) for v in all_views(open_log(path))] == [5, 8]


def test_consistent_log_gives_the_same_poses_either_way(tmp_path: Path) -> None:
    lines = [line for k in range(5) for line in (odom((k - 0.1, 0, 0), k - 0.1), straight(k))]
    path = log(tmp_path, *lines)
    scans, odoms = all_views(open_log(path)), all_views(open_log(path, poses="odom"))
    for a, b in zip(scans, odoms, strict=True):
        np.testing.assert_allclose(a.T_odom_base, b.T_odom_base, atol=1e-9)


def test_scans_come_in_order_of_time(tmp_path: Path) -> None:
    views = all_views(open_log(log(tmp_path, straight(0), straight(2), straight(1), straight(3))))
    assert [v.stamp for v in views] == [0, 1, 2, 3]
    assert [v.index for v in views] == [0, 1, 2, 3]


@pytest.mark.parametrize(
    ("beams", "fov", "degrees"),
    [(180, "180", 1), (181, "180", 1), (361, "180", 0.5), (5, "90", 22.5)],
)
def test_beams_span_the_field_of_view(tmp_path: Path, beams: int, fov: str, degrees: float) -> None:
    (view,) = all_views(open_log(log(tmp_path, straight(0, beams)), fov=fov))
    assert view.scan is not None
    assert math.degrees(view.scan.angle_increment) == pytest.approx(degrees)
    assert math.degrees(view.scan.angle_min) == pytest.approx(-float(fov) / 2)


def test_robotlaser_states_its_own_angles_and_limit(tmp_path: Path) -> None:
    line = (
        "ROBOTLASER1 0 -1.5 3.0 0.5 20.0 0.01 0 4 1.0 2.0 20.0 3.0 1 7 "
        "1.1 2.0 0.0 1.0 2.0 0.0 0 0 0 0 0 12.5 robot 0.5"
    )
    (view,) = all_views(open_log(log(tmp_path, line)))
    assert view.scan is not None
    assert view.T_base_laser is not None
    assert view.scan.angle_min == -1.5
    assert view.scan.angle_increment == 0.5
    assert view.scan.hit.tolist() == [True, True, False, True]
    assert view.stamp == 12.5
    np.testing.assert_allclose(view.T_odom_base[:2, 3], [1, 2])
    np.testing.assert_allclose(view.T_base_laser[:2, 3], [0.1, 0], atol=1e-9)


def test_front_laser_is_read_where_both_forms_are_logged(tmp_path: Path) -> None:
    other = straight(1).replace("FLASER", "ROBOTLASER1")
    assert len(open_log(log(tmp_path, straight(0), other))) == 1


reals = st.floats(-1e4, 1e4)
poses = st.tuples(reals, reals, st.floats(-math.pi, math.pi))


@given(st.lists(st.floats(0, 100), min_size=1, max_size=40), poses, poses, st.floats(0, 2e9))
def test_scan_line_round_trip(
    ranges: list[float], laser: Numbers, robot: Numbers, stamp: float
) -> None:
    """What a line says is what the parser reads, whatever the numbers."""
    read = parse_scan(flaser(tuple(ranges), laser, robot, stamp).encode(), math.pi, 80.0)
    assert read.laser == laser
    assert read.robot == robot
    assert read.stamp == stamp
    hit = read.scan.hit
    np.testing.assert_array_equal(read.scan.ranges_m[hit], np.array(ranges, np.float32)[hit])
    for r, returned in zip(ranges, hit, strict=True):
        if r >= 80 or r < 0.01:
            assert not returned


@given(st.integers(0, 400))
def test_scan_line_cut_anywhere_is_never_read_as_whole(cut: int) -> None:
    line = flaser(tuple(1.0 + k / 7 for k in range(20)), (1, 2, 3), (4, 5, 6), 7.25).encode()
    words = line.split()
    kept = line[: min(cut, len(line) - len(words[-1]) - 1)]
    with pytest.raises(BadFrame):
        parse_scan(kept, math.pi, 80.0)


@given(poses, st.floats(0, 2e9))
def test_odometry_line_round_trip(robot: Numbers, stamp: float) -> None:
    read = parse_odometry(odom(robot, stamp).encode())
    assert read.robot == robot
    assert read.stamp == stamp


@given(poses)
def test_pose_after_its_inverse_is_the_origin(pose: Numbers) -> None:
    back = compose(invert(Pose(*pose)), Pose(*pose))
    assert np.allclose(back, 0, atol=1e-6)


# Bad input


@pytest.mark.parametrize(
    ("bad", "why"),
    [
        (straight(1)[:30], "cut short"),
        (straight(1).replace(" 2.0 2.0", " 2.0 two", 1), "'two' is not a number"),
        (straight(1) + " 7", "too long"),
        (straight(1).replace("FLASER 5", "FLASER five"), "number of readings"),
        (straight(1).replace("FLASER 5", "FLASER -5"), "-5 readings"),
        ("FLASER", "number of readings"),
        (flaser((2.0,) * 5, (1, 0, 0), (math.nan, 0, 0), 1.0), "finite"),
        (flaser((), (1, 0, 0), (1, 0, 0), 1.0), "laser scan of shape"),
        (straight(1).replace("2.0", "\N{DEGREE SIGN}", 1), "not a number"),
    ],
)
def test_bad_line_is_skipped_with_its_number(tmp_path: Path, bad: str, why: str) -> None:
    path = log(tmp_path, straight(0), bad, straight(2))
    frames = list(open_log(path).views())
    assert [type(f) for f in frames] == [View, SkippedFrame, View]
    assert isinstance(frames[1], SkippedFrame)
    assert frames[1].where == f"{path} line 4"
    assert why in frames[1].why


def test_last_line_cut_short_costs_one_scan(tmp_path: Path) -> None:
    path = log(tmp_path, *(straight(k) for k in range(4)))
    path.write_bytes(path.read_bytes()[:-25])
    frames = list(open_log(path).views())
    assert [type(f) for f in frames] == [View, View, View, SkippedFrame]


def test_log_without_scans_is_refused(tmp_path: Path) -> None:
    with pytest.raises(SourceError, match="without laser scans"):
        open_log(log(tmp_path, odom((0, 0, 0), 1.0)))


def test_options_are_checked(tmp_path: Path) -> None:
    path = log(tmp_path, straight(0))
    with pytest.raises(SourceError, match="unknown option 'speed'"):
        open_log(path, speed="fast")
    with pytest.raises(SourceError, match="option fov='0'"):
        open_log(path, fov="0")


def test_other_files_are_left_to_other_sources(tmp_path: Path) -> None:
    path = tmp_path / "server.log"
    path.write_text("GET /index.html 200\n")
    noise = tmp_path / "noise.log"
    noise.write_bytes(np.random.default_rng(1).bytes(4000))
    for uri in (str(path), str(noise), str(tmp_path), "world:home"):
        assert afkb_open_source(uri, {}, None) is None  # type: ignore[arg-type]
