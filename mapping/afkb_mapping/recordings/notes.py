"""What a source tells its user of how a recording was read."""

from __future__ import annotations

from afkb.plugins.protocols import Source


def notes_of(source: Source) -> tuple[str, ...]:
    """The source's notes; a source need not have any."""
    return tuple(getattr(source, "notes", ()))
