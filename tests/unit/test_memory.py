"""What is remembered of views: read again it is the same to the bit, moved it moves rigidly."""

from dataclasses import replace

import numpy as np
import pytest

from afkb.errors import BadFrame, MapError, SourceError
from afkb.inference import network_of
from afkb.knowledge import AfNet
from afkb_mapping.geometry import T_from_xy_yaw
from afkb_mapping.mapper import AffordanceMapper
from afkb_mapping.memory.familiar import ENOUGH_LOOKS
from afkb_mapping.memory.memory import Memory
from afkb_mapping.memory.packing import packed, unpacked
from afkb_mapping.memory.remembered import RememberedView
from afkb_mapping.memory.storing import MEMORY_FILE, from_bytes, memory_of, to_bytes
from afkb_mapping.memory.visit import Visit
from afkb_mapping.panorama import panorama_of
from mapping_samples import container, support, support_below, support_near, view


def noisy(seen, seed=0):
    """A view whose depth and scan are no round numbers."""
    rng = np.random.default_rng(seed)
    depth = (seen.depth_m + rng.normal(0, 0.2, seen.depth_m.shape)).astype(np.float32)
    depth[:3] = 0
    ranges = (seen.scan.ranges_m + rng.normal(0, 0.01, 360)).astype(np.float32)
    ranges[:5] = np.inf
    return replace(seen, depth_m=depth, scan=replace(seen.scan, ranges_m=ranges))


def remembered(index=0, **pose):
    cup, table = container(2.0, 0.1), support(2.0123456, 0.0, cut=True)
    joined = replace(cup, parts=(cup, replace(cup, detector="things", affordances={"Lift": 0.4})))
    wall = replace(support(2.9, 0.0), segment_xy=np.array([[2.9, -1.0], [2.9, 1.0 / 3]]))
    said = (support_below(0), support_near(1))
    seen = RememberedView(noisy(view(index, **pose), index), (joined, table, wall), said)
    return seen.thinned()


def visit(**more):
    return Visit("recording", {"stride": 1}, np.eye(4), frames=9, **more)


def memory_of_views(*seen):
    memory = Memory()
    memory.begin(visit())
    for one in seen:
        memory.keep(one)
    return memory


def test_a_view_that_is_unpacked_is_the_one_that_was_packed():
    before = remembered(x=0.3, yaw=0.7)
    after = unpacked(packed(before))
    assert repr(after.hypotheses) == repr(before.hypotheses)
    assert repr(after.detections) == repr(before.detections)
    for a, b in zip(after.detections, before.detections, strict=True):
        np.testing.assert_array_equal(a.footprint_xy, b.footprint_xy)
    for name in ("index", "stamp", "camera", "T_odom_base", "T_map_base", "T_base_camera"):
        assert repr(getattr(after.view, name)) == repr(getattr(before.view, name))
    assert after.view.scan.angles.tolist() == before.view.scan.angles.tolist()
    np.testing.assert_array_equal(after.view.depth_m, before.view.depth_m)
    np.testing.assert_array_equal(after.view.scan.ranges_m, before.view.scan.ranges_m)


def test_a_thinned_view_shows_the_same_panorama():
    seen = view(x=0.3, yaw=0.7)
    fine = replace(seen.camera, width=640, height=480, fx=560.0, fy=560.0, cx=318.0, cy=238.0)
    whole = replace(seen, camera=fine, depth_m=np.full((480, 640), 2.0, np.float32))
    thin = RememberedView(whole, (), ()).thinned().view
    assert thin.depth_m.size * 16 == whole.depth_m.size
    for name in ("obstacle_m", "tall_m", "floor_m", "free_m"):
        expected = getattr(panorama_of(whole), name)
        np.testing.assert_allclose(getattr(panorama_of(thin), name), expected, atol=1e-6)


def test_what_a_view_saw_moves_with_it_and_back():
    before, T = remembered(x=0.3, yaw=0.2), T_from_xy_yaw(5.0, -1.0, 1.4)
    there = before.moved_to(T @ before.T_map_base)
    cup = there.detections[0]
    x, y, z, _ = T @ [*before.detections[0].position_xyz, 1]
    assert cup.position_xyz == pytest.approx((x, y, z)) == cup.box.center_xyz
    assert cup.box.yaw == pytest.approx(1.4)
    assert cup.footprint_xy.mean(axis=0) == pytest.approx((x, y), abs=0.01)
    back = there.moved_to(before.T_map_base)
    for a, b in zip(back.detections, before.detections, strict=True):
        np.testing.assert_allclose(a.footprint_xy, b.footprint_xy, atol=1e-9)
        np.testing.assert_allclose(a.covariance_xyz, b.covariance_xyz, atol=1e-12)
    np.testing.assert_allclose(back.detections[2].segment_xy, before.detections[2].segment_xy)
    assert before.moved_to(before.T_map_base) is before


def test_hardly_a_pixel_and_no_scan_is_a_bad_frame():
    seen = view()
    depth = np.zeros_like(seen.depth_m)
    depth[1, 1] = 99.0
    with pytest.raises(BadFrame, match="hardly a pixel"):
        RememberedView(replace(seen, scan=None, depth_m=depth), (), ()).thinned()


def test_a_mapper_makes_the_same_map_of_what_was_stored():
    def mapped(views):
        mapper = AffordanceMapper(network_of(AfNet()), "log-odds")
        for r in views:
            mapper.add(r.view, r.detections, r.hypotheses)
        return mapper.finish(np.eye(4))

    seen = [remembered(i, y=0.4 * i) for i in range(4)]
    first, again = mapped(seen), mapped(from_bytes(to_bytes(memory_of_views(*seen))).views)
    assert [repr(e) for e in first.entities] == [repr(e) for e in again.entities]
    assert repr(first.bounds) == repr(again.bounds) and repr(first.edges) == repr(again.edges)
    np.testing.assert_array_equal(first.grid.probability, again.grid.probability)


def test_a_robot_that_stands_and_watches_is_remembered_ever_more_rarely():
    memory = memory_of_views()
    worth = [memory.is_worth_keeping(view(i)) for i in range(1000)]
    assert all(worth[:ENOUGH_LOOKS]) and sum(worth) == ENOUGH_LOOKS + 5
    assert memory.is_worth_keeping(view(1000, x=0.6))
    assert memory.is_worth_keeping(view(1000, yaw=0.4))
    memory.begin(visit())
    assert memory.is_worth_keeping(view(1001))


def test_settled_poses_move_views_and_what_is_not_remembered_between_them():
    memory = memory_of_views(remembered(0))
    memory.pass_by(view(1, x=1.0))
    memory.keep(remembered(2, x=2.0))
    T = T_from_xy_yaw(0.0, 0.5, 0.0)
    memory.settle([T @ view(0).T_map_base, view(2, x=2.0).T_map_base])
    assert memory.trajectory[:, [4, 8]] == pytest.approx(np.array([[0, 0.5], [1, 0.5], [2, 0]]))
    stored = from_bytes(to_bytes(memory))
    assert [r.T_map_base[1, 3] for r in stored.settled_views] == [0.5, 0.0]
    assert [r.T_map_base[1, 3] for r in stored.views] == [0.0, 0.0]
    assert [r.T_map_base[1, 3] for r in stored.continued().views] == [0.5, 0.0]
    with pytest.raises(ValueError, match="1 poses for 2"):
        memory.settle([np.eye(4)])


def test_an_interrupted_visit_is_recalled_view_by_view():
    memory = memory_of_views(remembered(0))
    memory.begin(visit(first_index=9, clock_offset_s=100.0))
    for i in (9, 11):
        memory.keep(remembered(i))
    assert len(memory.before_last_visit().views) == 1
    known = memory.of_last_visit()
    assert known.of(noisy(view(9), 9)).view.index == 9
    assert known.of(view(10)) is None and not known.is_used_up
    assert repr(known.of(noisy(view(11), 11)).detections) == repr(remembered(11).detections)
    assert known.is_used_up and known.of(view(12)) is None


def test_another_recording_is_not_taken_for_the_interrupted_one():
    memory = memory_of_views(remembered(0))
    with pytest.raises(SourceError, match=r"frame 0 .* another recording"):
        memory.of_last_visit().of(noisy(view(0), seed=5))
    with pytest.raises(SourceError, match=r"frame 3 .* another recording"):
        memory.of_last_visit().of(noisy(view(3)))


@pytest.mark.parametrize(
    "spoilt",
    [
        lambda whole: whole[: len(whole) // 2],
        lambda whole: b"not an archive",
        lambda whole: whole.replace(b"rows.npy", b"rags.npy"),
    ],
)
def test_a_torn_memory_is_told_by_one_clear_error(tmp_path, spoilt):
    with pytest.raises(MapError, match=f"no state/{MEMORY_FILE}"):
        memory_of(tmp_path)
    (tmp_path / "state").mkdir()
    whole = to_bytes(memory_of_views(remembered()))
    (tmp_path / "state" / MEMORY_FILE).write_bytes(spoilt(whole))
    with pytest.raises(MapError, match=f"{MEMORY_FILE}: not readable .torn.*map again"):
        memory_of(tmp_path)


def test_a_memory_of_a_later_format_is_refused(tmp_path, monkeypatch):
    monkeypatch.setattr("afkb_mapping.memory.storing.FORMAT", 2)
    whole = to_bytes(memory_of_views(remembered()))
    monkeypatch.undo()
    with pytest.raises(ValueError, match="format 2, this afkb reads 1"):
        from_bytes(whole)


def test_bytes_that_are_no_view_are_refused():
    with pytest.raises(MapError, match="remembered view can't be read"):
        unpacked(packed(remembered())[:-9])
