"""Which form an answer has is the client's choice."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from afkb.serving.negotiation import preferred

OFFERED = ("application/json", "text/csv", "application/xml")


@pytest.mark.parametrize(
    ("accept", "chosen"),
    [
        ("", "application/json"),
        ("*/*", "application/json"),
        ("text/csv", "text/csv"),
        ("text/*", "text/csv"),
        ("TEXT/CSV ; charset=utf-8", "text/csv"),
        ("application/json;q=0.4, text/csv;q=0.5", "text/csv"),
        ("application/*;q=0.2, application/xml", "application/xml"),
        ("*/*;q=0.1, application/json;q=0", "text/csv"),
        ("text/html,application/xhtml+xml,application/xml;q=0.9,*/*;q=0.8", "application/xml"),
        ("image/png", None),
        ("text/csv;q=0", None),
        ("nonsense", None),
        ("nonsense, text/csv", "text/csv"),
        ("text/csv;q=2, application/xml;q=0.1", "application/xml"),
    ],
)
def test_the_wish_with_the_highest_quality_is_met(accept: str, chosen: str | None) -> None:
    assert preferred(accept, OFFERED) == chosen


@given(st.text(st.sampled_from("tex/*csv;q=0.19, application/json")))
def test_whatever_the_header_says_the_choice_is_offered_or_none(accept: str) -> None:
    assert preferred(accept, OFFERED) in (*OFFERED, None)
