"""Doorways found over a recording, against a list made by eye from the home's plan.

With the laser, and from depth alone; what the views show is merged at their true poses.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from afkb.flow import View
from afkb_mapping.doorways.merger import DoorwayMerger
from afkb_mapping.grid.input import insert_view
from afkb_mapping.grid.occupancy import GridBuilder
from afkb_mapping.structure import PASSAGE
from bench.calibration.measures import summary
from bench.detectors.data import Asked, Home
from bench.doorway_labels import Row, is_so, list_for, rates, said, scored

NEEDS = ("homes",)
WAYS = ("laser", "depth alone")


def run(asked: Asked) -> dict[str, Any]:
    """Recall and precision by home and way, and of all homes that have a list.

    Beside it, of what single views state: how often it is so.
    """
    listed = {h.name: list_for(h.folder) for h in asked.homes}
    result: dict[str, Any] = {
        "homes": {},
        "without a list": [name for name, of_home in listed.items() if of_home is None],
    }
    stated: dict[str, list[tuple[float, bool]]] = {way: [] for way in WAYS}
    for home in asked.homes:
        of_home = listed[home.name]
        if of_home is None:
            continue
        ways = result["homes"][home.name] = {}
        for way in WAYS:
            claims, found = seen_in(home, way)
            ways[way] = scored(of_home, found)
            judged = [(p, is_so(of_home, claim)) for p, claim in claims]
            stated[way] += [(p, so) for p, so in judged if so is not None]
    for way in WAYS:
        scores = [ways[way] for ways in result["homes"].values()]
        sums = (sum(s[k] for s in scores) for k in ("found", "listed", "right", "claims"))
        result[way] = {**rates(*sums), "single views": _holds(stated[way])}
    return result


def _holds(stated: Sequence[tuple[float, bool]]) -> dict[str, Any] | None:
    """How well what single views state comes true; None where they state nothing."""
    if not stated:
        return None
    p, right = np.array(stated, dtype=np.float64).T
    return summary(p, right, np.full(len(p), PASSAGE))


def seen_in(home: Home, way: str) -> tuple[list[tuple[float, Row]], list[Row]]:
    """What single views claim, with its probability, and the likely doorways of the home.

    In its world frame.
    """
    detector = home.host.detectors(["doorways"])[0]
    merger, grid = DoorwayMerger(), GridBuilder()
    claims: list[tuple[float, Row]] = []
    for view in home.views():
        seen: View = replace(view, scan=None, T_base_laser=None) if way != "laser" else view
        detections = detector.detect(seen, ())
        merger.add(seen, detections)
        insert_view(grid, seen)
        for d in detections:
            x, y, _ = d.box.center_xyz
            claims.append((d.affordances[PASSAGE], {"x": x, "y": y, "yaw": d.box.yaw}))
    found = [
        {
            **{k: round(getattr(d, k), 3) for k in ("x", "y", "yaw", "width", "probability")},
            "views": d.views,
        }
        for d in merger.doorways(grid.grid())
    ]
    return claims, found


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
        if holds := result[way]["single views"]:
            yield (
                f"  single views: {holds['samples']} claims, stated {holds['stated']:.2f} on "
                f"average, {holds['right']:.2f} are so, expected calibration error "
                f"{holds['ece']:.3f}"
            )
    if result["without a list"]:
        yield f"no list of doorways: {', '.join(result['without a list'])}"
