"""How segments are held against true rooms, and the peers that are measured beside ours."""

import numpy as np
import pytest

from bench.mapping.floorplans import afkb
from bench.mapping.room_jitter import drawings, steadiness
from bench.mapping.room_peers import morphological, voronoi, watershed
from bench.mapping.room_scores import regions, scores


def quarters(*labels):
    """Four rooms of 20 x 20 cells each in a row, by their labels."""
    return np.repeat(np.array(labels, np.int32), 20)[None].repeat(20, axis=0)


def test_the_same_regions_score_one():
    true = quarters(1, 2, 3, 4)
    found = scores(quarters(3, 1, 4, 2), true)
    assert [found[m] for m in ("precision", "recall", "mcc", "mcc_cells")] == [1.0] * 4


def test_over_segmentation_keeps_precision_and_under_segmentation_recall():
    halves = quarters(1, 1, 2, 2)
    split = scores(quarters(1, 2, 3, 4), halves)
    assert (split["precision"], split["recall"]) == (1.0, 0.5)
    merged = scores(halves, quarters(1, 2, 3, 4))
    assert (merged["precision"], merged["recall"]) == (0.5, 1.0)


def test_only_paired_regions_have_a_matthews_coefficient():
    # A half for a quarter: tp 400, fp 400, tn 800, fn 0; two of four rooms have no partner.
    paired = (400 * 800) / np.sqrt(800 * 400 * 1200 * 800)
    assert scores(quarters(1, 1, 2, 2), quarters(1, 2, 3, 4))["mcc"] == pytest.approx(paired / 2)


def test_no_segment_scores_nothing():
    found = scores(np.zeros((20, 80), np.int32), quarters(1, 2, 3, 4))
    assert (found["mcc"], found["segments"], found["rooms"]) == (0.0, 0, 4)


@pytest.mark.parametrize("segment", [watershed, morphological, voronoi])
def test_peers_part_two_rooms_at_a_door(segment):
    free = np.ones((120, 240), bool)
    free[[0, -1], :], free[:, [0, -1]] = False, False
    free[:, 118:122] = False
    true = regions(free)
    free[50:66, 118:122] = True
    assert scores(segment(free, 0.05), true)["mcc"] > 0.95


def two_rooms():
    """4 x 6 m with a wall and a door in it."""
    free = np.ones((80, 120), bool)
    free[[0, -1], :], free[:, [0, -1]] = False, False
    free[:, 58:61], free[32:48, 58:61] = False, True
    return free


def test_drawings_of_a_plan_lie_on_it_when_laid_back():
    free = two_rooms()
    for name, drawn, resolution, lay in drawings(free, 0.05):
        assert drawn.sum() * resolution**2 == pytest.approx(free.sum() * 0.05**2, rel=0.08), name
        laid = lay(drawn.astype(np.int32)) > 0
        assert (laid & free).sum() > 0.9 * (laid | free).sum(), name


def test_two_rooms_are_steady_and_what_counts_cells_is_not():
    free = two_rooms()
    assert min(steadiness(afkb, free, 0.05).values()) > 0.95

    def striped(drawn, resolution_m):
        return np.where(drawn, 1 + np.indices(drawn.shape)[1] // 30, 0).astype(np.int32)

    assert min(steadiness(striped, free, 0.05).values()) < 0.9
