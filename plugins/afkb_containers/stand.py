"""What a thing stands on."""

from __future__ import annotations

from enum import StrEnum


class Stand(StrEnum):
    """What a thing stands on: a support in sight, one that is hidden, or the floor."""

    ON_SUPPORT = "on_support"
    HIDDEN = "hidden"
    ON_FLOOR = "on_floor"
