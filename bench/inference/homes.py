"""What rooms are for, from recordings: every room that the robot stood in, against the truth.

    python -m bench.inference homes [--map MAP --home HOME]... [--homes FOLDER] [--json]

A home is a folder with `bag/` and `truth.json`. Homes without a `--map` are mapped first, which
takes minutes each; a map that is given is built anew from what it remembers, so that it is today's
inference that is judged. A room of the map is the one in which most views of a true room were
taken; where two true rooms share one, each is asked for. The `belief` of the map (affordances
alone) stands beside those of all room classifiers that are registered.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from afkb.flow import TopologicalMap
from afkb.plugins.host import PluginHost
from afkb_mapping.rooms.opinions import with_opinions
from afkb_paper.rooms import AFFORDANCES, JudgedRoom, judged_rooms
from afkb_paper.truth_file import truth_of
from bench.detectors.data import Home
from bench.inference.home_maps import add_arguments, home_maps
from bench.inference.rebuilt import rebuilt

__all__ = ["add_arguments", "run", "table"]


def run(args: argparse.Namespace) -> dict[str, Any]:
    """A row per true room, and how many are right by each classifier."""
    host = PluginHost()
    rows: list[dict[str, Any]] = []
    for folder, home in home_maps(args, host):
        rows += _judged(rebuilt(folder, host), home, host)
    return {"rooms": rows, "summary": summary(rows)}


def _judged(found: TopologicalMap, home: Home, host: PluginHost) -> list[dict[str, Any]]:
    found = with_opinions(found, host.room_classifiers())
    return room_rows(found, home.truth, home.name)


def room_rows(found: TopologicalMap, truth: Mapping[str, Any], home: str) -> list[dict[str, Any]]:
    """Per true room that the robot stood in: the mapped room of most of its views, and beliefs."""
    return [
        {
            "home": home,
            "room": room.name,
            "category": room.category or None,
            "views": room.views,
            "mapped": room.mapped.id,
            "shared": room.shared,
            "area_m2": round(room.mapped.area, 1),
            **_told(room),
        }
        for room in judged_rooms(found, truth_of(truth))
    ]


def _told(room: JudgedRoom) -> dict[str, Any]:
    second = room.mapped.second_purpose[0] if room.mapped.second_purpose else None
    return {
        "second": second,
        "second_right": second in room.right,
        "beliefs": {
            by: {
                "best": room.told(by),
                "p_best": round(max(belief.values()), 3),
                "p_true": round(sum(belief.get(r, 0.0) for r in room.right), 3),
                "right": room.is_right(by),
            }
            for by, belief in room.beliefs.items()
        },
    }


def summary(rows: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """Of all true rooms: right ones and mean P(truth), by who tells, and rooms of their own."""
    told = sorted({by for row in rows for by in row["beliefs"]})
    return {
        "rooms": len(rows),
        "of_their_own": sum(row["shared"] == 1 for row in rows),
        "right_by_either_purpose": sum(
            row["beliefs"][AFFORDANCES]["right"] or row["second_right"] for row in rows
        ),
        "by": {
            by: {
                "right": sum(row["beliefs"][by]["right"] for row in rows if by in row["beliefs"]),
                "mean_p_true": round(
                    sum(r["beliefs"][by]["p_true"] for r in rows if by in r["beliefs"]) / len(rows),
                    3,
                ),
            }
            for by in told
        },
    }


def table(result: dict[str, Any]) -> Iterator[str]:
    """A line per true room, then the sums."""
    for row in result["rooms"]:
        told = "; ".join(
            f"{by}: {t['best']} {t['p_best']:.2f}{'' if t['right'] else ' (wrong)'}"
            for by, t in row["beliefs"].items()
        )
        second = f", also {row['second']}" if row["second"] else ""
        place = f"{row['mapped']} of {row['area_m2']} m2" + (
            f", shared by {row['shared']}" if row["shared"] > 1 else ""
        )
        yield f"{row['home']:12} {row['room']:16} {place}: {told}{second}"
    sums = result["summary"]
    yield f"{sums['rooms']} rooms, {sums['of_their_own']} of them with a mapped room of their own"
    for by, told in sums["by"].items():
        yield f"{by:24} right {told['right']}, mean P(truth) {told['mean_p_true']}"
    yield f"{'either purpose':24} right {sums['right_by_either_purpose']}"
