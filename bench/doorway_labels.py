"""Lists of doorways made by eye (`bench/labels/README.md`), and what of them was found.

The list is `doorways.csv` in the home's folder, else `bench/labels/doorways-NAME.csv` (a home that
was recorded again, `NAME-later`, has the list of `NAME`).
"""

from __future__ import annotations

import csv
import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

LABELS = Path(__file__).parent / "labels"
COUNTED = ("door", "opening")
NEITHER = "mouth"
ACROSS_M, ALONG_M, ALONG_SHARE = 0.4, 0.3, 0.25
"""A doorway is found where its middle is: within a wall's thickness and the errors of both."""
TURNED_RAD = math.radians(35)

Row = dict[str, Any]


def list_for(home: Path) -> list[Row] | None:
    """The list of a home's folder, numbers as numbers; None where nobody has made one."""
    names = (home.name, home.name.removesuffix("-later"))
    places = [home / "doorways.csv", *(LABELS / f"doorways-{n}.csv" for n in names)]
    path = next((p for p in places if p.is_file()), None)
    if path is None:
        return None
    with path.open(newline="") as file:
        rows = list(csv.DictReader(file))
    numbers = ("x", "y", "width_m", "yaw")
    return [{**r, **{k: float(r[k]) for k in numbers}, "jambs": int(r["jambs"])} for r in rows]


def scored(listed: Sequence[Row], claims: Sequence[Row]) -> Row:
    """Recall and precision of claims (`x`, `y`, `yaw`, `width`; m, rad, frame of the list).

    A claim on the mouth of a corridor is neither right nor wrong.
    """
    hits = [[e for e in listed if is_at(e, c)] for c in claims]
    wanted = [e for e in listed if e["kind"] in COUNTED and e["jambs"] == 2]
    missed = [e["id"] for e in wanted if not any(e in hit for hit in hits)]
    kinds = [{e["kind"] for e in hit} for hit in hits]
    wrong = [c for c, k in zip(claims, kinds, strict=True) if not k & {*COUNTED, NEITHER}]
    neither = sum(k == {NEITHER} for k in kinds)
    judged = len(claims) - neither
    return {
        **rates(len(wanted) - len(missed), len(wanted), judged - len(wrong), judged),
        "missed": missed,
        "wrong": wrong,
        "doorways": [
            {**c, "is": [e["id"] for e in hit]} for c, hit in zip(claims, hits, strict=True)
        ],
    }


def is_so(listed: Sequence[Row], claim: Row) -> bool | None:
    """Whether one passes from room to room where a single view claims it.

    None at the mouth of a corridor, and at a doorway with a side that the recording doesn't show.
    """
    hits = [e for e in listed if is_at(e, claim)]
    if any(e["kind"] in COUNTED and e["jambs"] == 2 for e in hits):
        return True
    return None if any(e["kind"] in (*COUNTED, NEITHER) for e in hits) else False


def rates(found: int, listed: int, right: int, claims: int) -> Row:
    """Recall and precision beside what they are of."""
    return {
        "found": found,
        "listed": listed,
        "recall": found / listed if listed else None,
        "right": right,
        "claims": claims,
        "precision": right / claims if claims else None,
    }


def is_at(entry: Row, claim: Row) -> bool:
    """Whether a doorway that is claimed is the one that is listed."""
    dx, dy = claim["x"] - entry["x"], claim["y"] - entry["y"]
    c, s = math.cos(entry["yaw"]), math.sin(entry["yaw"])
    turned = abs((claim["yaw"] - entry["yaw"] + math.pi / 2) % math.pi - math.pi / 2)
    along = max(ALONG_M, ALONG_SHARE * entry["width_m"])
    return abs(dx * c + dy * s) < ACROSS_M and abs(dy * c - dx * s) < along and turned < TURNED_RAD


def said(score: Row) -> str:
    """Recall and precision in words."""

    def share(value: float | None) -> str:
        return "-" if value is None else f"{value:.2f}"

    return (
        f"recall {share(score['recall'])} ({score['found']} of {score['listed']}), "
        f"precision {share(score['precision'])} ({score['right']} of {score['claims']})"
    )
