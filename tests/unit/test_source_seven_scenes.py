"""The 7-Scenes source: the recorded kitchen, small folders, and every kind of bad frame."""

from __future__ import annotations

import shutil
from pathlib import Path

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from afkb.errors import BadFrame, SourceError
from afkb.flow import SkippedFrame, View
from afkb.plugins.protocols import Source
from afkb.testing import check_source
from afkb_mapping.depth_png import decode_png16
from afkb_seven_scenes import afkb_open_source

WIDTH, HEIGHT = 16, 12
K = "20 0 8\n0 20 6\n0 0 1\n"
POSE = "1 0 0 0.5\n0 1 0 0\n0 0 1 0\n0 0 0 1\n"


def open_folder(path: Path, **options: str) -> Source:
    source = afkb_open_source(str(path), options, None)  # type: ignore[arg-type]
    assert source is not None
    return source


def refusal(path: Path, **options: str) -> str:
    with pytest.raises(SourceError) as refused:
        open_folder(path, **options)
    assert "\n" not in str(refused.value)
    return str(refused.value)


def depth_png(path: Path, pixels: np.ndarray) -> None:
    path.write_bytes(cv2.imencode(".png", pixels)[1].tobytes())


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Three frames, 0, 2 and 4, of a wall 1.5 m away, with a pixel at 0 and one at 65535."""
    pixels = np.full((HEIGHT, WIDTH), 1500, np.uint16)
    pixels[0, 0], pixels[0, 1] = 0, 65535
    for k in (0, 2, 4):
        depth_png(tmp_path / f"frame-{k:06d}.depth.png", pixels)
        (tmp_path / f"frame-{k:06d}.pose.txt").write_text(POSE)
    (tmp_path / "camera-intrinsics.txt").write_text(K)
    return tmp_path


def middle(folder: Path, **options: str) -> str:
    """Why the middle frame is skipped, while its neighbours are not."""
    frames = list(open_folder(folder, **options).views())
    assert [type(f) for f in frames] == [View, SkippedFrame, View]
    assert isinstance(frames[1], SkippedFrame)
    assert frames[1].index == 1
    assert frames[1].where.endswith("frame-000002")
    return frames[1].why


def test_recorded_kitchen_keeps_the_contract(data_dir: Path) -> None:
    check_source(open_folder(data_dir / "redkitchen"), at_most=3)


def test_recorded_kitchen_is_read_as_it_was_recorded(data_dir: Path) -> None:
    source = open_folder(data_dir / "redkitchen")
    assert len(source) == 500
    assert not source.gravity_aligned
    (view,) = source.views(10, 11)
    assert isinstance(view, View)
    assert view.index == 10
    assert view.stamp == pytest.approx(20 / 30)  # frame-000020, at 30 frames a second
    assert view.camera is not None
    assert view.camera.fx == 585
    assert view.color is None  # not registered to depth
    assert not view.has_base
    assert view.T_base_camera is not None
    given = np.loadtxt(data_dir / "redkitchen" / "frame-000020.pose.txt")
    np.testing.assert_allclose(view.T_odom_base @ view.T_base_camera, given, atol=1e-12)
    raw = cv2.imread(str(data_dir / "redkitchen" / "frame-000020.depth.png"), cv2.IMREAD_UNCHANGED)
    assert view.depth_m is not None
    np.testing.assert_allclose(view.depth_m, np.where(raw == 65535, 0, raw) / 1000, atol=1e-6)


def test_base_looks_ahead_with_z_up_where_the_camera_is_level(folder: Path) -> None:
    """An identity camera pose looks along world z: so does the base's x axis; its z is -y."""
    view = next(iter(open_folder(folder).views()))
    assert isinstance(view, View)
    np.testing.assert_allclose(view.T_odom_base[:3, 0], [0, 0, 1])
    np.testing.assert_allclose(view.T_odom_base[:3, 2], [0, -1, 0])
    np.testing.assert_allclose(view.T_odom_base[:3, 3], [0.5, 0, 0])


def test_0_and_65535_are_no_return(folder: Path) -> None:
    view = next(iter(open_folder(folder).views()))
    assert isinstance(view, View)
    assert view.depth_m is not None
    assert view.depth_m[0, :3].tolist() == [0, 0, 1.5]


def test_only_asked_frames_are_read(folder: Path) -> None:
    (folder / "frame-000002.depth.png").write_bytes(b"never opened")
    frames = list(open_folder(folder).views(stride=2))
    assert [f.index for f in frames] == [0, 2]
    assert all(isinstance(f, View) for f in frames)


def test_intrinsics_may_lie_one_folder_up(folder: Path) -> None:
    sequence = folder / "seq-01"
    sequence.mkdir()
    for path in folder.glob("frame-*"):
        path.rename(sequence / path.name)
    assert len(open_folder(sequence)) == 3
    assert "holds sequences, not frames" in refusal(folder)


def test_intrinsics_may_be_given(folder: Path) -> None:
    (folder / "camera-intrinsics.txt").unlink()
    view = next(iter(open_folder(folder, intrinsics="30,31,8,6").views()))
    assert isinstance(view, View)
    assert view.camera is not None
    assert (view.camera.fx, view.camera.fy, view.camera.cx, view.camera.cy) == (30, 31, 8, 6)


def test_depth_scale_is_units_a_metre(folder: Path) -> None:
    view = next(iter(open_folder(folder, depth_scale="5000").views()))
    assert isinstance(view, View)
    assert view.depth_m is not None
    assert view.depth_m[5, 5] == pytest.approx(0.3)


def test_registered_colour_is_rgb_where_it_exists(folder: Path) -> None:
    blue = np.zeros((HEIGHT, WIDTH, 3), np.uint8)
    blue[..., 0] = 255  # OpenCV's order is blue, green, red
    depth_png(folder / "frame-000000.color.png", blue)
    first, second, _ = open_folder(folder, color="registered").views()
    assert isinstance(first, View)
    assert isinstance(second, View)
    assert first.color is not None
    assert first.color[0, 0].tolist() == [0, 0, 255]
    assert second.color is None
    assert next(iter(open_folder(folder).views())).color is None  # type: ignore[union-attr]


def test_colour_of_another_size_is_not_registered(folder: Path) -> None:
    depth_png(folder / "frame-000002.color.png", np.zeros((5, 5, 3), np.uint8))
    assert "registered colour has depth's 16x12" in middle(folder, color="registered")


# Bad input


WHOLE = cv2.imencode(".png", np.arange(192, dtype=np.uint16).reshape(HEIGHT, WIDTH) + 900)[1]


@given(st.integers(0, WHOLE.size - 1))
def test_png_cut_anywhere_is_never_believed(length: int) -> None:
    with pytest.raises(BadFrame):
        decode_png16(WHOLE.tobytes()[:length])


@given(st.integers(0, WHOLE.size - 1), st.integers(1, 255))
def test_png_with_a_wrong_byte_is_never_believed(at: int, change: int) -> None:
    data = bytearray(WHOLE.tobytes())
    data[at] ^= change
    with pytest.raises(BadFrame):
        decode_png16(bytes(data))


def test_truncated_png_is_skipped(folder: Path) -> None:
    path = folder / "frame-000002.depth.png"
    path.write_bytes(path.read_bytes()[:-20])
    assert "frame-000002.depth.png: PNG is cut short" in middle(folder)


def test_damaged_png_is_skipped(folder: Path) -> None:
    path = folder / "frame-000002.depth.png"
    data = bytearray(path.read_bytes())
    data[len(data) - 20] ^= 1
    path.write_bytes(bytes(data))
    assert "damaged" in middle(folder)


@pytest.mark.parametrize(
    ("pixels", "why"),
    [
        (np.full((HEIGHT, WIDTH), 90, np.uint8), "8 bits a pixel, depth needs 16"),
        (np.full((HEIGHT, WIDTH, 3), 90, np.uint16), "3 channels"),
        (np.zeros((HEIGHT, WIDTH), np.uint16), "no valid pixel"),
        (np.full((HEIGHT, WIDTH), 65535, np.uint16), "no valid pixel"),
        (np.full((HEIGHT, WIDTH + 1), 900, np.uint16), "the camera says"),
    ],
)
def test_unusable_depth_is_skipped(folder: Path, pixels: np.ndarray, why: str) -> None:
    depth_png(folder / "frame-000002.depth.png", pixels)
    assert why in middle(folder)


@pytest.mark.parametrize(
    ("text", "why"),
    [
        (POSE.replace("0.5", "nan"), "not finite"),
        (POSE.replace("0.5", "-inf"), "not finite"),
        ("1 0 0\n", "3 numbers"),
        (POSE.replace("0.5", "far"), "far"),
        (POSE.replace("1 0 0 0.5", "2 0 0 0.5"), "not a rotation"),
        ("", "0 numbers"),
    ],
)
def test_unusable_pose_is_skipped(folder: Path, text: str, why: str) -> None:
    (folder / "frame-000002.pose.txt").write_text(text)
    assert why in middle(folder)


def test_frame_without_pose_is_skipped(folder: Path) -> None:
    (folder / "frame-000002.pose.txt").unlink()
    assert "no frame-000002.pose.txt for this depth image" in middle(folder)


def test_frame_without_depth_is_skipped(folder: Path) -> None:
    (folder / "frame-000002.depth.png").unlink()
    assert "no frame-000002.depth.png for this pose" in middle(folder)


def test_one_odd_image_at_the_start_does_not_set_the_size(folder: Path) -> None:
    depth_png(folder / "frame-000000.depth.png", np.full((4, 4), 900, np.uint16))
    frames = list(open_folder(folder).views())
    assert [type(f) for f in frames] == [SkippedFrame, View, View]


def test_missing_intrinsics_are_refused(folder: Path) -> None:
    (folder / "camera-intrinsics.txt").unlink()
    why = refusal(folder)
    assert "camera-intrinsics.txt: no intrinsics" in why
    assert "fx 0 cx" in why


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("0 0 0\n0 0 0\n0 0 0\n", "must be positive"),
        (K.replace("20", "nan"), "must be positive"),
        (K.replace("8", "nan"), "must be finite"),
        ("20 20 8 6", "4 numbers, expected 9"),
        ("fx fy", "not numbers"),
        ("", "0 numbers"),
        (K.replace("8", "320"), "outside the 16x12 depth image"),
    ],
)
def test_unusable_intrinsics_are_refused(folder: Path, text: str, why: str) -> None:
    (folder / "camera-intrinsics.txt").write_text(text)
    refused = refusal(folder)
    assert str(folder / "camera-intrinsics.txt") in refused
    assert why in refused


def test_empty_folder_is_refused(tmp_path: Path) -> None:
    assert "the folder is empty" in refusal(tmp_path)


@pytest.mark.parametrize("kind", ["depth.png", "pose.txt"])
def test_folder_without_any_depth_or_pose_is_refused(folder: Path, kind: str) -> None:
    for path in folder.glob(f"*.{kind}"):
        path.unlink()
    assert f"no frame-XXXXXX.{kind}" in refusal(folder)


def test_folder_of_files_that_are_no_png_is_refused(folder: Path) -> None:
    for path in folder.glob("*.depth.png"):
        path.write_bytes(b"random bytes")
    assert "none of its depth images is a PNG" in refusal(folder)


def test_options_are_checked(folder: Path) -> None:
    assert "unknown option 'intrinsic'" in refusal(folder, intrinsic="1,2,3,4")
    assert "option intrinsics='1,2'" in refusal(folder, intrinsics="1,2")
    assert "option depth_scale='0'" in refusal(folder, depth_scale="0")


def test_other_folders_are_left_to_other_sources(tmp_path: Path) -> None:
    (tmp_path / "something.txt").write_text("else")
    shutil.copy(tmp_path / "something.txt", tmp_path / "frame.txt")
    for uri in (str(tmp_path), str(tmp_path / "absent"), "world:home"):
        assert afkb_open_source(uri, {}, None) is None  # type: ignore[arg-type]
