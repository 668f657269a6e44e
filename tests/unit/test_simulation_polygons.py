"""Plane polygons: triangles cover what the polygon covers."""

from __future__ import annotations

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from afkb_simulation.polygons import contains, crosses_itself, signed_area, triangulate

Star = list[tuple[float, float]]


@st.composite
def stars(draw: st.DrawFn) -> Star:
    """A simple polygon around the origin, counter-clockwise, often not convex."""
    radii = draw(st.lists(st.floats(0.5, 5), min_size=3, max_size=12))
    turn = 2 * math.pi / len(radii)
    return [(r * math.cos(i * turn), r * math.sin(i * turn)) for i, r in enumerate(radii)]


@settings(deadline=None)
@given(stars())
def test_triangles_add_up_to_the_polygon(polygon: Star) -> None:
    triangles = [[polygon[i] for i in t] for t in triangulate(polygon)]
    assert all(signed_area(t) > -1e-9 for t in triangles)
    assert sum(signed_area(t) for t in triangles) == pytest.approx(signed_area(polygon))
    assert len(triangles) == len(polygon) - 2


@settings(deadline=None)
@given(stars(), st.integers(-600, 600), st.integers(-600, 600))
def test_inside_is_inside_one_of_the_triangles(polygon: Star, i: int, j: int) -> None:
    x, y = i / 100 + math.pi / 1e3, j / 100 + math.e / 1e3
    within = sum(contains([polygon[i] for i in t], (x, y)) for t in triangulate(polygon))
    assert within == contains(polygon, (x, y))


@settings(deadline=None)
@given(stars())
def test_winding_shows_in_the_sign_and_nothing_crosses(polygon: Star) -> None:
    assert signed_area(polygon) > 0
    assert signed_area(polygon[::-1]) == pytest.approx(-signed_area(polygon))
    assert not crosses_itself(polygon)
