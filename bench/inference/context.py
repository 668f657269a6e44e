"""What surroundings do for things that are there, and against false ones, from recordings.

    python -m bench.inference context [--map MAP --home HOME]... [--homes FOLDER] [--json]

A home is a folder with `bag/` and `truth.json`. Homes without a `--map` are mapped first; a map
that is given is built anew from what it remembers. Of the same tracks, a map is made with context
and one without; all else is equal. Considered is what a map could state: doubtful detections too.
A surface is right where things of the truth with their tops at its height have most of its
outline (rims, lower boards and arms of chairs are not in the truth: false); what is no surface,
where one thing has its outline and rises as it does. Recall is of the right ones among those
considered; `found` are of the truth's things that were seen well.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from unittest.mock import patch

import numpy as np
from shapely import unary_union
from shapely.geometry import box

from afkb.flow import Entity, NodeKind
from afkb.inference import Network
from afkb.inference.recognition import CountsOf, is_floor
from afkb.plugins.host import PluginHost
from afkb_mapping import snapshot
from afkb_mapping.geometry import T_from_xy_yaw
from afkb_mapping.things.recognition import in_context, recognised
from bench.beliefs import word_of
from bench.detectors.data import Home
from bench.home_things import outline_of, overlap, same_height, seen_well
from bench.homes import NO_SUPPORT, in_world
from bench.inference import things
from bench.inference.context_scores import SURFACES, THINGS, WITH, WITHOUT, by_kind
from bench.inference.home_maps import add_arguments, home_maps
from bench.inference.rebuilt import rebuilt

WITHIN = 0.6
"""From this share of its outline at tops of the truth on a surface is right."""
BESIDE_M = 0.05
__all__ = ["add_arguments", "run", "table"]


@dataclass(frozen=True)
class Inputs:
    """What tells a map's things by their surroundings is given, once a map is made."""

    entities: Sequence[Entity]
    counts_of: CountsOf
    network: Network


def run(args: argparse.Namespace) -> dict[str, Any]:
    """Per kind, of all homes together and of each: scores without and with context."""
    host = PluginHost()
    nodes: list[dict[str, Any]] = []
    well: list[dict[str, Any]] = []
    for folder, home in home_maps(args, host):
        own = judged(inputs_of(folder, host), home)
        nodes += own
        well += well_seen(own, home)
    names = list(dict.fromkeys(node["home"] for node in nodes))
    return {
        "together": by_kind(nodes, well),
        "homes": {name: by_kind(*(_of(name, rows) for rows in (nodes, well))) for name in names},
    }


def inputs_of(folder: Path, host: PluginHost) -> Inputs:
    """What a map tells things by, when it is built anew."""
    last: list[Inputs] = []

    def listening(entities: Sequence[Entity], counts: CountsOf, network: Network) -> list[Entity]:
        last[:] = [Inputs(entities, counts, network)]
        return recognised(entities, counts, network)

    with patch.object(snapshot, "recognised", listening):
        rebuilt(folder, host)
    return last[0]


def judged(inputs: Inputs, home: Home) -> list[dict[str, Any]]:
    """A row per thing considered: whether it is right, how sure it is, and where it is stated."""
    told = {WITHOUT: _told(inputs, lambda entities, *_: list(entities)), WITH: _told(inputs)}
    seen = [
        e
        for e in inputs.entities
        if e.kind is NodeKind.OBSERVED and not is_floor(e) and e.id in told[WITH][0]
    ]
    start = home.truth["views"][0]
    nodes = in_world(
        [things.node_of(e) for e in seen], T_from_xy_yaw(start["x"], start["y"], start["yaw"])
    )
    return [
        {
            **node,
            "home": home.name,
            "kind": SURFACES if e.affords("SupportAbility") else THINGS,
            "right": is_right(node, home.truth["things"]),
            "p": {by: sure[e.id] for by, (sure, _) in told.items()},
            "in_map": {by: e.id in stated for by, (_, stated) in told.items()},
        }
        for e, node in zip(seen, nodes, strict=True)
    ]


def _told(inputs: Inputs, surrounding: Any = in_context) -> tuple[dict[str, float], set[str]]:
    """How sure everything considered is, and what the map then states."""
    sure: dict[str, float] = {}

    def listening(entities: Sequence[Entity], *rest: Any) -> list[Entity]:
        now: list[Entity] = surrounding(entities, *rest)
        sure.update({e.id: e.existence for e in now})
        return now

    stated = recognised(inputs.entities, inputs.counts_of, inputs.network, listening)
    return sure, {e.id for e in stated}


def is_right(node: dict[str, Any], true_things: Sequence[dict[str, Any]]) -> bool:
    """Whether a surface is top of things of the truth, or what is none is one of them."""
    if "SupportAbility" not in node["affords"]:
        return any(overlap(node, t, word_of(t)) > 0 for t in true_things)
    outline = outline_of(node)
    tops = [
        box(*np.subtract(t["min"][:2], BESIDE_M), *np.add(t["max"][:2], BESIDE_M))
        for t in true_things
        if same_height(node, t, word_of(t))
    ]
    covered = outline.intersection(unary_union(tops)).area
    return bool(covered >= WITHIN * outline.area > 0)


def well_seen(nodes: Sequence[dict[str, Any]], home: Home) -> list[dict[str, Any]]:
    """A row per thing of the truth that was seen well, with the rows of the nodes that are it."""
    return [
        {
            "home": home.name,
            "kind": THINGS if t["movable"] and t["on"] else SURFACES,
            "nodes": [n for n in nodes if overlap(n, t, word_of(t)) > 0],
        }
        for t in home.truth["things"]
        if word_of(t) not in NO_SUPPORT and seen_well(t)
    ]


def _of(name: str, rows: Sequence[dict[str, Any]]) -> list[dict[str, Any]]:
    return [row for row in rows if row["home"] == name]


def table(result: dict[str, Any]) -> Iterator[str]:
    """All homes together, then each: a line per kind and per threshold."""
    for name, kinds in {"together": result["together"], **result["homes"]}.items():
        for kind, told in kinds.items():
            yield f"{name}, {kind}: {told['considered']} considered, {told['right']} right"
            for by, sure in told["sure"].items():
                yield f"  {by:8} " + ", ".join(f"{k} {v}" for k, v in sure.items())
            for threshold, at in told["at"].items():
                for by in (WITHOUT, WITH):
                    yield (
                        f"  at {threshold:5} {by:8} {at[by]['right']} of {at[by]['stated']} right, "
                        f"precision {at[by]['precision']}, recall {at[by]['recall']}, "
                        f"found {at[by]['found']} of {told['seen_well']}"
                    )
                yield (
                    f"  {'':8} rose {at['rose']} ({at['rose_rightly']} rightly), "
                    f"fell {at['fell']} ({at['fell_rightly']} rightly)"
                )
