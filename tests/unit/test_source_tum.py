"""The TUM RGB-D source: small folders, other people's variations, and every kind of bad line."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from afkb.errors import SourceError
from afkb.flow import SkippedFrame, View
from afkb.testing import check_source
from afkb_mapping.recordings.pose_file import Damaged, read_poses
from afkb_tum import afkb_open_source
from tum_samples import T0, open_tum, png, tum_folder, write_poses

CAMERA_YAML = "fx: 30\nfy: 31\ncx: 8\ncy: 6\ndepth_scale: 1000\n"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return tum_folder(tmp_path)


def views(folder: Path, **options: str) -> list[View]:
    frames = list(open_tum(folder, **options).views())
    assert all(isinstance(f, View) for f in frames), frames
    return [f for f in frames if isinstance(f, View)]


def notes(folder: Path, **options: str) -> str:
    return " | ".join(getattr(open_tum(folder, **options), "notes", ()))


def refusal(folder: Path, **options: str) -> str:
    with pytest.raises(SourceError) as refused:
        open_tum(folder, **options)
    assert "\n" not in str(refused.value)
    return str(refused.value)


def bare_refusal(folder: Path) -> str:
    with pytest.raises(SourceError) as refused:
        afkb_open_source(str(folder), {}, None)  # type: ignore[arg-type]
    return str(refused.value)


def middle(folder: Path) -> str:
    """Why the middle frame is skipped, while its neighbours are not."""
    frames = list(open_tum(folder).views())
    assert [type(f) for f in frames] == [View, SkippedFrame, View]
    assert isinstance(frames[1], SkippedFrame)
    return frames[1].why


def test_keeps_the_contract(folder: Path) -> None:
    check_source(open_tum(folder))


def test_pose_is_interpolated_at_the_image(folder: Path) -> None:
    """Images are halfway between two poses; the camera looks along the world's z."""
    for k, view in enumerate(views(folder)):
        assert view.stamp == pytest.approx(T0 + 0.1 * k, abs=1e-6)
        assert view.T_base_camera is not None
        T_world_camera = view.T_odom_base @ view.T_base_camera
        np.testing.assert_allclose(T_world_camera[:3, 3], [0.1 * k, 0, 0], atol=1e-4)
        np.testing.assert_allclose(T_world_camera[:3, :3], np.eye(3), atol=1e-12)
        assert not view.has_base


def test_depth_is_in_units_of_a_fifth_of_a_millimetre_unless_said(folder: Path) -> None:
    for options, depth_m in (({}, 1.5), ({"depth_scale": "1000"}, 7.5)):
        (first, *_) = views(folder, **options)
        assert first.depth_m is not None
        assert first.depth_m[5, 5] == pytest.approx(depth_m)


def test_colour_is_the_nearest_in_time_as_rgb_and_can_be_left_out(folder: Path) -> None:
    colors = [v.color for v in views(folder)]
    assert [None if c is None else c[0, 0].tolist() for c in colors] == [
        [k, 0, 255] for k in range(3)
    ]
    assert [v.color for v in views(folder, color="none")] == [None] * 3
    assert [v.color for v in views(folder, max_dt="0.005")] == [None] * 3


def test_poses_in_any_order_and_damaged_lines_are_counted(folder: Path) -> None:
    path = folder / "groundtruth.txt"
    lines = path.read_text().splitlines()
    before = [v.T_odom_base for v in views(folder)]
    bad = ["1305031098.5 far 0 0 0 0 0 1", "1305031098.5 1 2", "1305031098.51 9 0 0 0 0 0 0"]
    path.write_text("\n".join([*reversed(lines), *bad]))
    np.testing.assert_array_equal([v.T_odom_base for v in views(folder)], before)
    told = notes(folder)
    assert "groundtruth.txt: 3 lines left out as unreadable, the first line" in told


def test_lists_in_any_order_give_frames_in_time_order(folder: Path) -> None:
    path = folder / "depth.txt"
    lines = path.read_text().splitlines()[1:]
    path.write_text("\n".join([*reversed(lines), lines[0], "1305031098.6", "nan depth/1.png"]))
    check_source(open_tum(folder))
    told = notes(folder)
    assert "depth.txt: 2 lines left out" in told
    assert "1 depth images repeat a stamp" in told


def test_association_file_in_either_order_serves_in_place_of_lists(folder: Path) -> None:
    before = [(v.stamp, v.color is not None) for v in views(folder)]
    depth, rgb = (
        [line for line in (folder / f"{n}.txt").read_text().splitlines() if line[0] != "#"]
        for n in ("depth", "rgb")
    )
    for name in ("depth", "rgb"):
        (folder / f"{name}.txt").unlink()
    for first, second in ((depth, rgb), (rgb, depth)):
        pairs = (f"{a} {b}" for a, b in zip(first, second, strict=True))
        (folder / "associations.txt").write_text("\n".join(pairs))
        assert [(v.stamp, v.color is not None) for v in views(folder)] == before


def test_unpacked_archive_with_a_folder_inside(tmp_path: Path) -> None:
    inner = tum_folder(_made(tmp_path / "rgbd_dataset_freiburg9_den"))
    assert len(open_tum(tmp_path)) == 3
    tum_folder(_made(tmp_path / "another"))
    assert "holds 2 recordings; name one" in refusal(tmp_path)
    assert len(open_tum(inner)) == 3


def _made(folder: Path) -> Path:
    folder.mkdir()
    return folder


def test_archive_that_is_still_packed_is_refused(tmp_path: Path) -> None:
    packed = tmp_path / "rgbd_dataset_freiburg1_xyz.tgz"
    packed.write_bytes(b"\x1f\x8b")
    assert "unpack it with `tar xzf`" in bare_refusal(packed)


def test_odometry_is_used_where_there_is_no_ground_truth(folder: Path) -> None:
    (folder / "groundtruth.txt").rename(folder / "odometry.txt")
    assert len(views(folder)) == 3
    (folder / "odometry.txt").rename(folder / "mine.txt")
    assert "no poses; expected depth.txt" in refusal(folder)
    assert len(views(folder, poses="mine.txt")) == 3
    assert "no such file" in refusal(folder, poses="yours.txt")


def test_poses_of_a_robot_with_a_mounted_camera(folder: Path) -> None:
    """The camera looks along the robot's x from 1 m up: optical x right, y down, z ahead."""
    source = open_tum(folder, mounted="0.1,0,1,-0.5,0.5,-0.5,0.5")
    assert source.gravity_aligned
    view = next(iter(source.views()))
    assert isinstance(view, View)
    assert view.has_base
    assert view.T_base_camera is not None
    np.testing.assert_allclose(view.T_base_camera[:3, 2], [1, 0, 0], atol=1e-12)
    np.testing.assert_allclose(view.T_base_camera[:3, 1], [0, 0, -1], atol=1e-12)
    np.testing.assert_allclose(view.T_base_camera[:3, 3], [0.1, 0, 1])
    assert "quaternion is zero" in refusal(folder, mounted="0,0,1,0,0,0,0")


def test_negative_fy_turns_the_world_over(folder: Path) -> None:
    """ICL-NUIM's camera has y up. What it sees above its middle must end up above it."""
    write_poses(folder / "groundtruth.txt", [(T0 + t, 0, 2, 0, 0, 0, 0, 1) for t in (-1, 1)])
    (view, *_) = views(folder, intrinsics="20,-20,8,6", max_gap="3")
    assert view.camera is not None
    assert view.camera.fy == 20
    assert view.T_base_camera is not None
    T_world_camera = view.T_odom_base @ view.T_base_camera
    np.testing.assert_allclose(T_world_camera[:3, 3], [0, -2, 0], atol=1e-12)


# The camera


def test_intrinsics_of_a_folder_named_after_the_benchmarks_are_known_and_told(
    tmp_path: Path,
) -> None:
    folder = tum_folder(_made(tmp_path / "rgbd_dataset_freiburg3_long_office_household"))
    for k in range(3):
        png(folder / "depth" / f"{k}.png", np.full((480, 640), 7500, np.uint16))
    source = afkb_open_source(str(folder), {"color": "none"}, None)  # type: ignore[arg-type]
    assert source is not None
    view = next(iter(source.views()))
    assert isinstance(view, View)
    assert view.camera is not None
    assert view.camera.fx == 535.4
    assert "535.4,539.2,320.1,247.6 are those of freiburg3" in getattr(source, "notes", ("",))[0]


@pytest.mark.parametrize(
    ("text", "scale"),
    [
        (CAMERA_YAML, 1000),
        ("%YAML:1.0\n---\nCamera.fx: 30.\nCamera.fy: 31.\nCamera.cx: 8.\nCamera.cy: 6.\n"
         "DepthMapFactor: 2500.0\nCamera.bf: 40.0\n", 2500),
        ("image_width: 16\ncamera_matrix:\n  rows: 3\n  cols: 3\n"
         "  data: [30, 0, 8, 0, 31, 6, 0, 0, 1]\n", 5000),
        ("%YAML:1.0\n---\ncamera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n"
         "   data: [30, 0, 8, 0, 31, 6, 0, 0, 1]\n", 5000),
    ],
    ids=["ours", "ORB-SLAM", "camera_calibration", "OpenCV"],
)  # fmt: skip
def test_calibration_files_of_several_tools(folder: Path, text: str, scale: float) -> None:
    (folder / "camera.yaml").write_text(text)
    source = afkb_open_source(str(folder), {}, None)  # type: ignore[arg-type]
    assert source is not None
    view = next(iter(source.views()))
    assert isinstance(view, View)
    assert view.camera is not None
    assert view.depth_m is not None
    camera = view.camera
    assert (camera.fx, camera.fy, camera.cx, camera.cy) == (30, 31, 8, 6)
    assert view.depth_m[0, 0] == pytest.approx(7500 / scale)


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("fx: 30\nfy: 31\ncx: 8\n", "cy: field required"),
        ("fx: far\nfy: 31\ncx: 8\ncy: 6\n", "fx: input should be a valid number"),
        ("fx: 30\nfy: 31\ncx: 320\ncy: 6\n", "outside the 16x12 depth image"),
        ("just words", "no calibration can be read"),
        ("{", "no calibration can be read"),
        (CAMERA_YAML.replace("1000", "0"), "depth_scale: input should be greater than 0"),
    ],
)
def test_unusable_calibration_is_refused(folder: Path, text: str, why: str) -> None:
    (folder / "camera.yaml").write_text(text)
    refused = bare_refusal(folder)
    assert str(folder / "camera.yaml") in refused
    assert why in refused
    assert "\n" not in refused


def test_missing_intrinsics_are_refused(folder: Path) -> None:
    assert "no intrinsics; write camera.yaml" in bare_refusal(folder)


def test_matrix_in_a_text_file_serves_too(folder: Path) -> None:
    (folder / "camera-intrinsics.txt").write_text("30 0 8\n0 31 6\n0 0 1\n")
    source = afkb_open_source(str(folder), {}, None)  # type: ignore[arg-type]
    assert source is not None
    assert isinstance(next(iter(source.views())), View)


# Bad input


def test_truncated_png_is_skipped(folder: Path) -> None:
    path = folder / "depth" / "1.png"
    path.write_bytes(path.read_bytes()[:-20])
    assert "1.png: PNG is cut short" in middle(folder)


def test_missing_image_is_skipped(folder: Path) -> None:
    (folder / "depth" / "1.png").unlink()
    assert "no 1.png" in middle(folder)


def test_colour_of_another_size_is_not_registered(folder: Path) -> None:
    png(folder / "rgb" / "1.png", np.zeros((5, 5, 3), np.uint8))
    assert "registered colour has depth's 16x12" in middle(folder)


def test_gap_in_the_poses_skips_the_frames_in_it(folder: Path) -> None:
    write_poses(
        folder / "groundtruth.txt",
        [(T0 + t, 0, 0, 0, 0, 0, 0, 1) for t in (-0.01, 0.01, 0.2, 0.21)],
    )
    assert len(views(folder)) == 3
    frames = list(open_tum(folder, max_gap="0.1").views())
    assert [type(f) for f in frames] == [View, SkippedFrame, View]


def test_stamps_that_never_meet_are_refused(folder: Path) -> None:
    write_poses(folder / "groundtruth.txt", [(t, 0, 0, 0, 0, 0, 0, 1) for t in (1.0, 2.0)])
    refused = refusal(folder)
    assert "groundtruth.txt is of 1.000 to 2.000 s" in refused
    assert "1305031098.500" in refused


def test_camera_that_never_moves_is_told(folder: Path) -> None:
    write_poses(folder / "groundtruth.txt", [(T0 + t, 1, 2, 3, 0, 0, 0, 1) for t in (0, 0.1, 0.2)])
    assert "all poses are at one place" in notes(folder)


@pytest.mark.parametrize("text", ["", "# nothing\n", "1 2 3\n", "a b c d e f g h\n"])
def test_trajectory_without_a_pose_is_refused(folder: Path, text: str) -> None:
    (folder / "groundtruth.txt").write_text(text)
    assert "groundtruth.txt: no pose; expected lines" in refusal(folder)


def test_list_without_an_image_is_refused(folder: Path) -> None:
    (folder / "depth.txt").write_text("# timestamp filename\n")
    assert "depth.txt: lists no depth image" in refusal(folder)


def test_folder_whose_images_are_gone_is_refused(folder: Path) -> None:
    for path in (folder / "depth").iterdir():
        path.unlink()
    assert "none of the depth images it lists is a PNG" in refusal(folder)


def test_options_are_checked(folder: Path) -> None:
    assert "unknown option 'scale'" in refusal(folder, scale="5000")
    assert "option mounted='1,2'" in refusal(folder, mounted="1,2")
    assert "option color='grey'" in refusal(folder, color="grey")


def test_other_folders_are_left_to_other_sources(tmp_path: Path) -> None:
    (tmp_path / "groundtruth.txt").write_text("")
    for uri in (str(tmp_path), str(tmp_path / "absent"), "world:home", __file__):
        assert afkb_open_source(uri, {}, None) is None  # type: ignore[arg-type]


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=25)
@given(st.text(max_size=80))
def test_any_text_as_a_trajectory_is_counted_or_read(tmp_path: Path, text: str) -> None:
    path = tmp_path / "any.txt"
    path.write_text(text, encoding="utf-8")
    track = read_poses(path, Damaged(path))
    assert all(np.isfinite(track.at(s, 1.0, 1.0)).all() for s in (track.span if len(track) else ()))


def test_an_empty_colour_image_costs_its_frame_only(folder: Path) -> None:
    (folder / "rgb" / "1.png").write_bytes(b"")
    frames = list(open_tum(folder).views())
    assert [isinstance(f, SkippedFrame) for f in frames] == [False, True, False]
    assert "color=none" in frames[1].why
    assert len(views(folder, color="none")) == 3


def test_another_data_sets_intrinsics_one_folder_up_are_told_or_left_alone(tmp_path: Path) -> None:
    (tmp_path / "camera-intrinsics.txt").write_text("30 0 8\n0 30 6\n0 0 1\n")
    (tmp_path / "mine").mkdir()
    mine = afkb_open_source(str(tum_folder(tmp_path / "mine")), {}, None)  # type: ignore[arg-type]
    assert mine is not None and "one folder up" in " ".join(mine.notes)  # type: ignore[attr-defined]
    (tmp_path / "rgbd_dataset_freiburg1_xyz").mkdir()
    assert "no intrinsics" in bare_refusal(tum_folder(tmp_path / "rgbd_dataset_freiburg1_xyz"))


def test_units_that_nobody_states_are_told(folder: Path) -> None:
    assert "depth_scale=1000" in notes(folder)
    assert "depth_scale=1000" not in notes(folder, depth_scale="5000")


def test_a_camera_with_y_up_is_no_robots(folder: Path) -> None:
    told = refusal(folder, intrinsics="20,-20,8,6", mounted="0,0,1,0,0,0,1")
    assert "negative fy" in told
