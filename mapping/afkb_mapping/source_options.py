"""Options of a source, as they stand on the command line."""

from __future__ import annotations

from collections.abc import Iterable

from afkb.errors import SourceError


def options_of(pairs: Iterable[str]) -> dict[str, str]:
    """Options written as key=value. Raises `SourceError` for one that isn't."""
    options = {}
    for pair in pairs:
        key, sign, value = pair.partition("=")
        if not sign or not key:
            raise SourceError(f"--option {pair}: write it as key=value")
        options[key] = value
    return options
