"""Source: a simulated world (`*.world.yaml`, or `world:NAME` for a bundled one), ray-cast."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from afkb.plugins import hookimpl

if TYPE_CHECKING:
    from afkb.flow import Truth
    from afkb.knowledge import AfNet
    from afkb.plugins.protocols import Source


@hookimpl
def afkb_open_source(uri: str, options: Mapping[str, str], knowledge_base: AfNet) -> Source | None:
    """Open `*.world.yaml` and `world:NAME`; option `seed` replaces the world's seed."""
    if not _is_world(uri):
        return None
    from afkb_simulation.source import open_world

    return open_world(uri, options)


@hookimpl
def afkb_truth(uri: str, knowledge_base: AfNet) -> Truth | None:
    """Return the truth of `*.world.yaml` and `world:NAME`."""
    if not _is_world(uri):
        return None
    from afkb_simulation.known import known_truth

    return known_truth(uri)


def _is_world(uri: str) -> bool:
    return uri.endswith(".world.yaml") or uri.startswith("world:")
