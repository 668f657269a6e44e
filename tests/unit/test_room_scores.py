"""How segments are held against true rooms, and the peers that are measured beside ours."""

import numpy as np
import pytest

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
