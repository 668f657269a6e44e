"""What things are held for, from recordings: those that were seen well, against the truth.

    python -m bench.inference things [--map MAP --home HOME]... [--homes FOLDER] [--json]

A home is a folder with `bag/` and `truth.json`. Homes without a `--map` are mapped first; a map
that is given is built anew from what it remembers. A thing is found where a node has its outline
and height. Told by itself (affordances, size, height), by its room too, and as the map states it:
with what carries it and boards over each other, too.
"""

from __future__ import annotations

import argparse
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from afkb.flow import Entity, NodeKind, TopologicalMap
from afkb.inference import Network, network_of
from afkb.inference.recognition import standing_together
from afkb.plugins.host import PluginHost
from afkb_mapping.geometry import T_from_xy_yaw
from bench.beliefs import meant
from bench.home_things import pairs
from bench.homes import in_world
from bench.inference.home_maps import add_arguments, home_maps
from bench.inference.rebuilt import rebuilt

ALONE, ROOM, MAP = "by itself", "with its room", "as the map states it"
__all__ = ["add_arguments", "run", "table"]

BINS = np.linspace(0.0, 1.0, 6)
"""Edges of the bins of the first guess's probability: a few dozen things fill no more than five."""


def run(args: argparse.Namespace) -> dict[str, Any]:
    """How many are right, by who tells; what is taken for what; how sure first guesses are."""
    host = PluginHost()
    rows: list[dict[str, Any]] = []
    for folder, home in home_maps(args, host):
        rows += judged(rebuilt(folder, host), home.truth, home.name, host)
    return {"things": rows, "summary": summary(rows), "taken_for": taken_for(rows)}


def judged(
    found: TopologicalMap, truth: dict[str, Any], home: str, host: PluginHost
) -> list[dict[str, Any]]:
    """A row per thing that was seen well: its word, and what it is held for by whom."""
    kb = host.knowledge_base
    start = truth["views"][0]
    T_world_map = T_from_xy_yaw(start["x"], start["y"], start["yaw"])
    beliefs = _beliefs(found, network_of(kb))
    nodes = [node_of(e) for e in found.entities if e.id in beliefs]
    rows = []
    for pair in pairs(in_world(nodes, T_world_map), truth):
        right = meant(pair.word, kb)
        node = pair.node["id"] if pair.node else None
        told = {by: _told(b, right) for by, b in beliefs[node].items()} if node else {}
        rows.append({"home": home, "thing": pair.thing["name"], "word": pair.word, "told": told})
    return rows


def _beliefs(found: TopologicalMap, network: Network) -> dict[str, dict[str, Mapping[str, float]]]:
    """Node to who tells to belief, of all things that were seen."""
    counts = {room.id: room.evidence for room in found.rooms}
    beliefs: dict[str, dict[str, Mapping[str, float]]] = {}
    groups = standing_together(found.entities, lambda room: counts.get(room or "", {}), network)
    for together in groups:
        for e, thing in zip(together.entities, together.things, strict=True):
            of = (thing.affordances, thing.size_xyz, thing.top_height_m, thing.whole)
            alone = network.objects.likelihood(*of)[:, None] * network.joint.placement.in_room
            room = np.array([together.room[r] for r in network.joint.placement.rooms])
            shares = alone @ room
            told = dict(zip(network.objects.categories, shares / shares.sum(), strict=True))
            by_itself = network.objects.posterior(*of)
            beliefs[e.id] = {ALONE: by_itself, ROOM: told, MAP: e.category_belief}
    return beliefs


def node_of(entity: Entity) -> dict[str, Any]:
    """An observed entity as `map.json` has it, as far as its place and outline go."""
    assert entity.kind is NodeKind.OBSERVED
    x, y, z = entity.position_xyz
    return {
        "id": entity.id,
        "x": x,
        "y": y,
        "z": z,
        "size": entity.size_xyz,
        "yaw": entity.yaw,
        "affords": [name for name in entity.affordances if entity.affords(name)],
    }


def _told(belief: Mapping[str, float], right: set[str]) -> dict[str, Any]:
    named = sorted(belief, key=lambda name: (-belief[name], name))[:5]
    return {
        "first": named[0],
        "p_first": round(float(belief[named[0]]), 4),
        "p_right": round(float(sum(belief.get(name, 0.0) for name in right)), 4),
        "right": named[0] in right,
        "among_five": bool(right.intersection(named)),
    }


def summary(rows: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """Things seen well and found, and by who tells: right ones, log loss, calibration error."""
    found = [row for row in rows if row["told"]]
    return {
        "seen_well": len(rows),
        "found": len(found),
        "by": {by: _scores([row["told"][by] for row in found]) for by in (ALONE, ROOM, MAP)},
    }


def _scores(told: Sequence[Mapping[str, Any]]) -> dict[str, float]:
    p_first = np.array([t["p_first"] for t in told])
    right = np.array([t["right"] for t in told], dtype=float)
    p_right = np.array([t["p_right"] for t in told])
    bins = np.clip(np.digitize(p_first, BINS) - 1, 0, len(BINS) - 2)
    gaps = [abs((p_first - right)[bins == b].sum()) for b in np.unique(bins)]
    return {
        "first": int(right.sum()),
        "among_five": sum(t["among_five"] for t in told),
        "mean_p_right": round(float(p_right.mean()), 3),
        "log_loss": round(float(-np.log(np.maximum(p_right, 1e-6)).mean()), 3),
        "calibration_error": round(float(sum(gaps) / len(told)), 3),
    }


def taken_for(rows: Sequence[Mapping[str, Any]]) -> dict[str, dict[str, int]]:
    """Word to what the map holds such things for at first, right and wrong, commonest first."""
    counts: dict[str, Counter[str]] = {}
    for row in rows:
        if row["told"]:
            told = row["told"][MAP]
            name = told["first"] + ("" if told["right"] else " (wrong)")
            counts.setdefault(row["word"], Counter())[name] += 1
    return {word: dict(counts[word].most_common()) for word in sorted(counts)}


def table(result: dict[str, Any]) -> Iterator[str]:
    """The sums by who tells, then a line per word."""
    sums = result["summary"]
    yield f"{sums['seen_well']} things seen well, {sums['found']} of them found"
    for by, scores in sums["by"].items():
        yield (
            f"{by:22} right at first {scores['first']}, among five {scores['among_five']}, "
            f"mean P(right) {scores['mean_p_right']}, log loss {scores['log_loss']}, "
            f"calibration error of the first {scores['calibration_error']}"
        )
    for word, names in result["taken_for"].items():
        yield f"{word:22} {', '.join(f'{n} {name}' for name, n in names.items())}"
