"""Outlines are simple rings in metres, whatever the cells look like."""

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from afkb_mapping.things.outlines import outline_of_cells

masks = arrays(
    np.uint8, st.tuples(st.integers(1, 12), st.integers(1, 12)), elements=st.integers(0, 1)
)


@given(masks.filter(lambda m: m.any()), st.sampled_from(["xy", "yx"]))
def test_every_outline_is_a_simple_ring(mask, axes):
    ring = outline_of_cells(mask, 0.04, np.array([-1.3, 2.2]), axes)
    assert len(ring) >= 3
    assert len(np.unique(ring, axis=0)) == len(ring)
    assert shapely.Polygon(ring).is_valid
    np.testing.assert_array_equal(ring, np.round(ring, 4))


@pytest.mark.parametrize("axes", ["xy", "yx"])
def test_a_rectangle_of_cells_has_its_borders(axes):
    mask = np.zeros((20, 30), np.uint8)
    mask[5:15, 10:14] = 1
    polygon = shapely.Polygon(outline_of_cells(mask, 0.1, np.zeros(2), axes))
    expected = (0.5, 1.0, 1.5, 1.4) if axes == "xy" else (1.0, 0.5, 1.4, 1.5)
    assert polygon.bounds == pytest.approx(expected, abs=1e-6)
    assert polygon.area == pytest.approx(0.4, abs=1e-6)


def test_an_empty_mask_is_refused():
    with pytest.raises(ValueError, match="empty"):
        outline_of_cells(np.zeros((3, 3), np.uint8), 0.1, np.zeros(2))
