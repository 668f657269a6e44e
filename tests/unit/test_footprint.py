import numpy as np
import pytest

from afkb_mapping.things.footprint import Footprint


def rectangle(width, depth, yaw=0.0, center=(0.0, 0.0), step=0.02):
    x, y = np.meshgrid(
        np.arange(-width / 2, width / 2, step), np.arange(-depth / 2, depth / 2, step)
    )
    c, s = np.cos(yaw), np.sin(yaw)
    return np.column_stack([x.ravel(), y.ravel()]) @ np.array([[c, s], [-s, c]]) + center


@pytest.mark.parametrize("yaw", [0.0, 0.4, -1.2])
def test_outline_recovers_a_turned_table(yaw):
    footprint = Footprint(0.04)
    footprint.add(rectangle(1.2, 0.8, yaw, (2.0, -1.0)))
    outline = footprint.outline()
    assert outline.center_xy == pytest.approx((2.0, -1.0), abs=0.03)
    assert outline.size_xy == pytest.approx((1.2, 0.8), abs=0.09)
    assert np.cos(2 * (outline.yaw - yaw)) > 0.98
    assert outline.area_m2 == pytest.approx(0.96, rel=0.12)


def test_partial_views_of_one_table_merge_to_the_whole():
    whole = rectangle(1.6, 0.8)
    footprint = Footprint(0.04)
    footprint.add(whole[whole[:, 0] < 0.2])
    footprint.add(whole[whole[:, 0] > -0.2])
    assert footprint.outline().size_xy == pytest.approx((1.6, 0.8), abs=0.09)


def test_stray_points_of_one_frame_do_not_widen_what_many_frames_saw():
    footprint = Footprint(0.04)
    for _ in range(30):
        footprint.add(rectangle(0.6, 0.6))
    footprint.add(np.array([[0.8, 0.0], [0.85, 0.02]]))
    assert footprint.outline().size_xy == pytest.approx((0.6, 0.6), abs=0.09)


def test_share_within_tells_beside_from_upon():
    footprint = Footprint(0.04)
    footprint.add(rectangle(1.0, 1.0))
    assert footprint.share_within(rectangle(0.2, 0.2), 0.0) == 1.0
    assert footprint.share_within(rectangle(0.2, 0.2, center=(2.0, 0.0)), 0.08) == 0.0


def test_absorbing_equals_having_seen_both():
    left, right = Footprint(0.04), Footprint(0.04)
    left.add(rectangle(0.4, 0.4, center=(-0.3, 0.1)))
    right.add(rectangle(0.4, 0.4, center=(0.3, -0.2)))
    both = Footprint(0.04)
    both.add(rectangle(0.4, 0.4, center=(-0.3, 0.1)))
    both.add(rectangle(0.4, 0.4, center=(0.3, -0.2)))
    left.absorb(right)
    np.testing.assert_array_equal(
        left.points()[np.lexsort(left.points().T)], both.points()[np.lexsort(both.points().T)]
    )
