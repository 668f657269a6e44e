"""What maps are called in a server: by their folders, unless someone says otherwise."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from afkb.errors import MapError


def named(folders: Sequence[Path], name: str | None = None, prefix: str = "") -> dict[str, Path]:
    """Map folders by the name that each gets in a server, in their order.

    `name` stands in for the folder's; `prefix` comes before it, with a `/`. `MapError` where two
    would get the same one, as the later would replace the earlier.
    """
    if name is not None and len(folders) > 1:
        raise MapError(f"--as {name}: is for one map, not {len(folders)}; see --prefix")
    found: dict[str, Path] = {}
    for folder in folders:
        own = name or folder.resolve().name
        called = f"{prefix.strip('/')}/{own}".strip("/")
        if called in found:
            raise MapError(
                f"{found[called]} and {folder} would both be kept as {called!r}; "
                "send them one by one, with --as or --prefix"
            )
        found[called] = folder
    return found
