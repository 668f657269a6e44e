"""Doorways found over a recording, against a list made by eye from the home's plan.

The list is `doorways.csv` in the home's folder, else `bench/labels/doorways-NAME.csv` (a home that
was recorded again, `NAME-later`, has the list of `NAME`). Its form: `bench/labels/README.md`.
"""

from __future__ import annotations

import csv
import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from afkb.flow import View
from afkb_mapping.doorway_merger import DoorwayMerger, SeenDoorway
from afkb_mapping.grid_input import insert_view
from afkb_mapping.occupancy import GridBuilder
from bench.detectors.data import Asked, Home

NEEDS = ("homes",)
LABELS = Path(__file__).parents[1] / "labels"
COUNTED = ("door", "opening")
NEITHER = "mouth"
ACROSS_M, ALONG_M, ALONG_SHARE = 0.4, 0.3, 0.25
"""A doorway is found where its middle is: within a wall's thickness and the errors of both."""
TURNED_RAD = math.radians(35)


def run(asked: Asked) -> dict[str, Any]:
    """Recall and precision by home, with the laser and from depth alone; all homes pooled."""
    homes = [h for h in asked.homes if _list_of(h) is not None]
    result: dict[str, Any] = {
        "homes": {
            h.name: {way: score(h, way == "depth alone") for way in ("laser", "depth alone")}
            for h in homes
        },
        "without a list": [h.name for h in asked.homes if h not in homes],
    }
    for way in ("laser", "depth alone"):
        scores = [ways[way] for ways in result["homes"].values()]
        result[way] = _rates(
            *(sum(s[k] for s in scores) for k in ("found", "listed", "right", "claims"))
        )
    return result


def score(home: Home, depth_alone: bool) -> dict[str, Any]:
    """What a home's doorways come to; a claim on a mouth of a corridor is neither."""
    listed = read_labels(_list_of(home) or LABELS)
    claims = found_in(home, depth_alone)
    hits = [[e for e in listed if is_at(e, c)] for c in claims]
    wanted = [e for e in listed if e["kind"] in COUNTED and e["jambs"] == 2]
    missed = [e["id"] for e in wanted if not any(e in hit for hit in hits)]
    wrong = [c for c, hit in zip(claims, hits, strict=True) if not _may_be(hit)]
    judged = [c for c, hit in zip(claims, hits, strict=True) if not _is_neither(hit)]
    right = len(judged) - len(wrong)
    return {
        **_rates(len(wanted) - len(missed), len(wanted), right, len(judged)),
        "missed": missed,
        "wrong": [_row(c) for c in wrong],
        "doorways": [
            {**_row(c), "is": [e["id"] for e in hit]} for c, hit in zip(claims, hits, strict=True)
        ],
    }


def _rates(found: int, listed: int, right: int, claims: int) -> dict[str, Any]:
    return {
        "found": found,
        "listed": listed,
        "recall": found / listed if listed else None,
        "right": right,
        "claims": claims,
        "precision": right / claims if claims else None,
    }


def found_in(home: Home, depth_alone: bool) -> list[SeenDoorway]:
    """The likely doorways, merged over all views at their true poses."""
    detector = home.host.detectors(["doorways"])[0]
    merger, grid = DoorwayMerger(), GridBuilder()
    for view in home.views():
        seen: View = replace(view, scan=None, T_base_laser=None) if depth_alone else view
        merger.add(seen, detector.detect(seen, ()))
        insert_view(grid, seen)
    return merger.doorways(grid.grid())


def _list_of(home: Home) -> Path | None:
    names = (home.name, home.name.removesuffix("-later"))
    places = [home.folder / "doorways.csv", *(LABELS / f"doorways-{n}.csv" for n in names)]
    return next((p for p in places if p.is_file()), None)


def read_labels(path: Path) -> list[dict[str, Any]]:
    """The entries of a list, numbers as numbers."""
    with path.open(newline="") as file:
        rows = list(csv.DictReader(file))
    numbers = ("x", "y", "width_m", "yaw")
    return [{**r, **{k: float(r[k]) for k in numbers}, "jambs": int(r["jambs"])} for r in rows]


def is_at(entry: dict[str, Any], found: SeenDoorway) -> bool:
    """Whether a doorway that was found is the one that is listed."""
    dx, dy = found.x - entry["x"], found.y - entry["y"]
    c, s = math.cos(entry["yaw"]), math.sin(entry["yaw"])
    turned = abs((found.yaw - entry["yaw"] + math.pi / 2) % math.pi - math.pi / 2)
    along = max(ALONG_M, ALONG_SHARE * entry["width_m"])
    return abs(dx * c + dy * s) < ACROSS_M and abs(dy * c - dx * s) < along and turned < TURNED_RAD


def _may_be(hit: Sequence[dict[str, Any]]) -> bool:
    return any(e["kind"] in (*COUNTED, NEITHER) for e in hit)


def _is_neither(hit: Sequence[dict[str, Any]]) -> bool:
    return bool(hit) and all(e["kind"] == NEITHER for e in hit)


def _row(c: SeenDoorway) -> dict[str, Any]:
    numbers = {"x": c.x, "y": c.y, "yaw": c.yaw, "width": c.width, "p": c.probability}
    return {**{k: round(v, 2) for k, v in numbers.items()}, "views": c.views}


def table(result: dict[str, Any]) -> Iterator[str]:
    for home, ways in result["homes"].items():
        for way, s in ways.items():
            yield f"{home}, {way}: {_said(s)}"
            yield f"  missed: {', '.join(s['missed']) or 'none'}"
            for c in s["wrong"]:
                yield f"  wrong: {c['width']} m wide at {c['x']}, {c['y']} (p {c['p']})"
    for way in ("laser", "depth alone"):
        yield f"all homes, {way}: {_said(result[way])}"
    if result["without a list"]:
        yield f"no list of doorways: {', '.join(result['without a list'])}"


def _said(s: dict[str, Any]) -> str:
    def share(value: float | None) -> str:
        return "-" if value is None else f"{value:.2f}"

    return (
        f"recall {share(s['recall'])} ({s['found']} of {s['listed']}), "
        f"precision {share(s['precision'])} ({s['right']} of {s['claims']})"
    )
