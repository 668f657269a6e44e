"""Which of the forms that are offered a client likes best (RFC 9110, section 12.5.1)."""

from __future__ import annotations

from collections.abc import Sequence


def preferred(accept: str, offered: Sequence[str]) -> str | None:
    """The offered media type with the highest quality, the first of equals; None if none will do.

    No wish is any form. A range that names a type beats one that names its family, and that
    beats `*/*`. A part that can't be read is passed over.

    >>> preferred("text/csv;q=0.5, application/json", ["text/csv", "application/json"])
    'application/json'
    >>> preferred("*/*, text/csv;q=0", ["text/csv", "application/json"])
    'application/json'
    """
    ranges = [found for part in accept.split(",") if (found := _range(part))]
    if not ranges:
        return offered[0] if not accept.strip(" ,") else None
    ranked = [(_quality(ranges, name), -number, name) for number, name in enumerate(offered)]
    quality, _, name = max(ranked)
    return name if quality > 0 else None


def _range(part: str) -> tuple[str, float] | None:
    name, *parameters = (piece.strip().lower() for piece in part.split(";"))
    if name.count("/") != 1 or name == "/":
        return None
    quality = 1.0
    for parameter in parameters:
        key, _, value = parameter.partition("=")
        if key.strip() == "q":
            try:
                quality = float(value)
            except ValueError:
                return None
    return (name, quality) if 0 <= quality <= 1 else None


def _quality(ranges: Sequence[tuple[str, float]], name: str) -> float:
    """What the narrowest range that covers a type gives it; 0 where none does."""
    family = name.partition("/")[0]
    for wanted in (name, f"{family}/*", "*/*"):
        for asked, quality in ranges:
            if asked == wanted:
                return quality
    return 0.0
