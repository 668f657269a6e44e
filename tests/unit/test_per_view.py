"""What is worked out of a view once."""

from dataclasses import replace

import laser_samples as laser
from afkb_mapping.per_view import once_per_view


def test_is_worked_out_once_for_each_view_and_forgotten_with_it():
    asked = []

    @once_per_view
    def index_of(view):
        asked.append(view.index)
        return view.index

    view = laser.view(laser.FLAT, (1, 1, 0), (1, 1, 0), beams=8)
    assert [index_of(view), index_of(view)] == [view.index] * 2
    other = replace(view, index=5)
    assert index_of(other) == 5
    assert asked == [view.index, 5]
    del other
    assert index_of(replace(view, index=5)) == 5
    assert len(asked) == 3
