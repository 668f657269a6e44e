"""Pictures of what is said of some views of each home; nothing is drawn without `--pictures`."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from bench.detectors.data import Asked
from bench.detectors.pictures import draw_views

NEEDS = ("homes",)


def run(asked: Asked) -> dict[str, Any]:
    """How many pictures were drawn, by home."""
    if asked.pictures is None:
        return {}
    return {h.name: draw_views(h.name, h.views(), h.seen, asked.pictures) for h in asked.homes}


def table(result: dict[str, Any]) -> Iterator[str]:
    for home, drawn in result.items():
        yield f"{home}: {drawn} pictures"
