"""What readers of recordings share: poses over time, and whether depth is in metres."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from afkb.errors import BadFrame
from afkb.flow import PinholeCamera, View
from afkb_mapping.optical import T_BODY_OPTICAL
from afkb_mapping.recordings.depth_units import DepthsSeen
from afkb_mapping.recordings.notes import notes_of
from afkb_mapping.recordings.pose_track import NS, T_from_pose, Track

ANGLES = st.floats(-3, 3)
PLACES = st.tuples(*(st.floats(-50, 50) for _ in range(3)))


def view(depth_m: float) -> View:
    depth = np.full((48, 64), depth_m, np.float32)
    camera = PinholeCamera(64, 48, 60, 60, 32, 24)
    return View(0, 0.0, np.eye(4), depth, camera, np.array(T_BODY_OPTICAL))


@pytest.mark.parametrize(
    ("depths", "why"),
    [((2.0, 3.0), None), ((0.3, 0.35), "nearer than"), ((10.0, 20.0, 2.0), "farther than")],
)
def test_depth_that_is_no_rooms_is_told(depths: tuple[float, ...], why: str | None) -> None:
    seen = DepthsSeen()
    for depth_m in depths:
        seen.add(view(depth_m))
    assert (seen.note is None) == (why is None)
    if why is not None:
        assert why in (seen.note or "")
        assert "depth_scale" in (seen.note or "")


def test_a_recording_without_depth_has_no_units() -> None:
    assert DepthsSeen().note is None


def test_a_source_need_not_have_notes() -> None:
    class Telling:
        notes = ("a line",)

    assert notes_of(object()) == ()  # type: ignore[arg-type]
    assert notes_of(Telling()) == ("a line",)  # type: ignore[arg-type]


@given(PLACES, PLACES, st.tuples(ANGLES, ANGLES, ANGLES), st.floats(0, 1))
def test_between_two_poses_one_moves_straight_and_turns_evenly(
    a: tuple[float, float, float],
    b: tuple[float, float, float],
    turn: tuple[float, float, float],
    share: float,
) -> None:
    """Half way a pose is half way; the turn so far is that share of the whole turn's angle."""
    turned = Rotation.from_rotvec(turn) if np.linalg.norm(turn) < 3 else Rotation.identity()
    track = Track()
    track.add(NS, b, tuple(turned.as_quat()))
    track.add(0, a, (0, 0, 0, 1))
    stamp = round(share * NS)
    T = track.at(stamp, max_dt=0, max_gap=1)
    np.testing.assert_allclose(T[:3, 3], np.array(a) + stamp / NS * (np.array(b) - a), atol=1e-9)
    so_far = Rotation.from_matrix(T[:3, :3]).magnitude()
    assert so_far == pytest.approx(stamp / NS * turned.magnitude(), abs=1e-6)


def test_outside_of_its_poses_the_nearest_serves_if_it_is_near() -> None:
    track = Track()
    for second in (1, 2):
        track.add(second * NS, (second, 0, 0), (0, 0, 0, 1))
    assert track.span == (NS, 2 * NS)
    assert track.at(round(2.05 * NS), max_dt=0.1, max_gap=0.3)[0, 3] == 2
    for stamp in (0.5, 1.5, 2.5):
        with pytest.raises(BadFrame, match="no transform within"):
            track.at(round(stamp * NS), max_dt=0.1, max_gap=0.3)


def test_a_pose_as_a_transform() -> None:
    T = T_from_pose((1, 2, 3, 0, 0, 2**-0.5, 2**-0.5))
    np.testing.assert_allclose(T @ [1, 0, 0, 1], [1, 3, 3, 1], atol=1e-12)
