"""Doorways found over a recording, against a list made by eye from the home's plan.

With the laser, and from depth alone; what the views show is merged at their true poses.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

from afkb.flow import View
from afkb_mapping.doorway_merger import DoorwayMerger
from afkb_mapping.grid_input import insert_view
from afkb_mapping.occupancy import GridBuilder
from bench.detectors.data import Asked, Home
from bench.doorway_labels import list_for, rates, said, scored

NEEDS = ("homes",)
WAYS = ("laser", "depth alone")


def run(asked: Asked) -> dict[str, Any]:
    """Recall and precision by home and way, and of all homes that have a list."""
    homes = {h.name: (h, list_for(h.folder)) for h in asked.homes}
    result: dict[str, Any] = {
        "homes": {
            name: {way: scored(listed, found_in(home, way)) for way in WAYS}
            for name, (home, listed) in homes.items()
            if listed is not None
        },
        "without a list": [name for name, (_, listed) in homes.items() if listed is None],
    }
    for way in WAYS:
        scores = [ways[way] for ways in result["homes"].values()]
        sums = (sum(s[k] for s in scores) for k in ("found", "listed", "right", "claims"))
        result[way] = rates(*sums)
    return result


def found_in(home: Home, way: str) -> list[dict[str, Any]]:
    """The likely doorways of a home, in its world frame."""
    detector = home.host.detectors(["doorways"])[0]
    merger, grid = DoorwayMerger(), GridBuilder()
    for view in home.views():
        seen: View = replace(view, scan=None, T_base_laser=None) if way != "laser" else view
        merger.add(seen, detector.detect(seen, ()))
        insert_view(grid, seen)
    return [
        {
            **{k: round(getattr(d, k), 3) for k in ("x", "y", "yaw", "width", "probability")},
            "views": d.views,
        }
        for d in merger.doorways(grid.grid())
    ]


def table(result: dict[str, Any]) -> Iterator[str]:
    for home, ways in result["homes"].items():
        for way, score in ways.items():
            yield f"{home}, {way}: {said(score)}"
            yield f"  missed: {', '.join(score['missed']) or 'none'}"
            for c in score["wrong"]:
                place = f"{c['width']:.2f} m wide at {c['x']:.2f}, {c['y']:.2f}"
                yield f"  wrong: {place} (p {c['probability']:.2f})"
    for way in WAYS:
        yield f"all homes, {way}: {said(result[way])}"
    if result["without a list"]:
        yield f"no list of doorways: {', '.join(result['without a list'])}"
