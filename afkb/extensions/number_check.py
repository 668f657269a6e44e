"""Checks the numbers of a file: probabilities, counts, lengths, ranges and fuzzy ranges."""

from __future__ import annotations

import math

from afkb.extensions.problems import Problems
from afkb.extensions.statements import Statements
from afkb.ontology.names import fragment

_PROBABILITIES = ("strength", "matchingWeight", "rate", "groundingStrength")
_POSITIVE = ("expectedNumber", "expectedCount", "dispersion")
_NOT_NEGATIVE = ("distanceMean", "distanceSd", "sizeXTypical", "sizeYTypical")
_NUMBERS = ("value", "z1", "n1", "n2", "z2", "evidenceBottomMin")
_RANGES = ("length", "width", "height", "mass", "top", "extent")
_GREATEST = {
    "length": 30.0, "width": 15.0, "height": 6.0, "top": 8.0, "mass": 20000.0,
    "distanceMean": 30.0, "distanceSd": 30.0, "sizeXTypical": 30.0, "sizeYTypical": 30.0,
}  # fmt: skip
"""What nothing in a home exceeds, m or kg: more was written in another unit."""


def check_numbers(statements: Statements, problems: Problems) -> None:
    """Note numbers that are none, or out of range, and ranges that are empty."""
    things = set(statements.of_type("ObjectCategory"))
    for subject in statements.values:
        _check_values(subject, statements, problems)
        _check_ranges(subject, subject in things, statements, problems)
        _check_trapezoid(subject, statements, problems)


def _check_values(subject: str, statements: Statements, problems: Problems) -> None:
    def note(prop: str, text: str, expected: str) -> None:
        place = statements.place(subject, prop)
        problems.add(place, f"{fragment(subject)}: {prop} {text} {expected}")

    for prop in (*_PROBABILITIES, *_POSITIVE, *_NOT_NEGATIVE, *_NUMBERS):
        for text in statements.many(subject, prop):
            value = _number(text)
            if value is None:
                note(prop, repr(text), "is no number; write one, with a point")
            elif prop in _PROBABILITIES and not 0 <= value <= 1:
                note(prop, f"{value:g}", "is not in 0..1; write a probability")
            elif prop in _POSITIVE and value <= 0:
                note(prop, f"{value:g}", "is not above 0; write 0.01 for what is very rare")
            elif prop in _NOT_NEGATIVE and value < 0:
                note(prop, f"{value:g}", "is below 0; write a length in metres")
            elif value > _GREATEST.get(prop, value):
                note(prop, f"{value:g}", _too_much(prop))


def _check_ranges(subject: str, is_thing: bool, statements: Statements, problems: Problems) -> None:
    for what in _RANGES:
        ends = [statements.one(subject, f"{what}{end}") for end in ("Min", "Max")]
        low, high = (_number(text) if text else None for text in ends)
        place = statements.place(subject, f"{what}Min" if ends[0] else f"{what}Max")
        for text, value in zip(ends, (low, high), strict=True):
            if text and value is None:
                problems.add(place, f"{fragment(subject)}: {what} {text!r} is no number; write one")
        if low is not None and high is not None and low > high:
            problems.add(
                place, f"{fragment(subject)}: {what} from {low:g} to {high:g} is empty; swap them"
            )
        elif low is not None and low <= 0 and is_thing and what != "top":
            problems.add(
                place,
                f"{fragment(subject)}: {what} {low:g} is not above 0; write metres or kilograms",
            )
        elif (most := high if high is not None else low) and most > _GREATEST.get(what, most):
            problems.add(place, f"{fragment(subject)}: {what} {most:g} {_too_much(what)}")


def _too_much(what: str) -> str:
    if what == "mass":
        return f"is above {_GREATEST[what]:g} kg; write kilograms, not grams"
    return f"is above {_GREATEST[what]:g} m; write metres, not centimetres"


def _check_trapezoid(subject: str, statements: Statements, problems: Problems) -> None:
    numbers = [_number(statements.one(subject, p) or "?") for p in ("z1", "n1", "n2", "z2")]
    found = [n for n in numbers if n is not None]
    if len(found) == 4 and found != sorted(found):
        shown = ", ".join(f"{n:g}" for n in found)
        problems.add(
            statements.place(subject),
            f"{fragment(subject)}: {shown} do not rise; write where the membership is 0, 1, 1, 0",
        )


def _number(text: str) -> float | None:
    try:
        value = float(text)
    except ValueError:
        return None
    return value if math.isfinite(value) else None
