"""What a map's sizes and neighbours tell of grasps, beside the true boxes of the same home.

Every small thing that has a node is asked for as what it truly is, once in the map and once among
the true boxes, so that only size and clearance differ.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from afkb.finding import Node, Region, Surroundings
from afkb.finding.grasping import CLEAR, Grasp, grasps
from bench.inference.true_places import TruePlaces

KINDS = {
    "cups": "Cup",
    "mug": "Mug",
    "bowl": "Bowl",
    "pitcher_base": "Pitcher",
    "master_chef_can": "Can",
    "mustard_bottle": "Bottle",
    "bleach_cleanser": "Bottle",
    "cracker_box": "CerealBox",
    "pudding_box": "Carton",
    "sugar_box": "Carton",
}
"""What each of the truth's words is held to be."""


def compared(homes: Sequence[TruePlaces], kb: Any) -> dict[str, Any]:
    """How often grasps of the whole thing fit and are clear, in the map and in truth."""
    pairs: list[tuple[Grasp | None, Grasp | None]] = []
    for places in homes:
        truth = _true_surroundings(places)
        for i, thing in enumerate(places.small):
            own = places.node_of(thing, places.around)
            if own is None or thing["word"] not in KINDS:
                continue
            mapped = _whole(own, KINDS[thing["word"]], places.around, kb)
            true = _whole(f"small-{i}", KINDS[thing["word"]], truth, kb)
            pairs += [(mapped.get(g), true.get(g)) for g in sorted({*mapped, *true})]
    both = [(m, t) for m, t in pairs if m and t]
    clear = np.array([m.clear for m, _ in both])
    true_clear = np.array([float(t.clear >= CLEAR) for _, t in both])
    widths = [abs(m.width - t.width) for m, t in both if m.width and t.width]
    return {
        "things": sum(len(places.small) for places in homes),
        "fits in the map and truly, only in the map, only truly": [
            len(both),
            sum(t is None for _, t in pairs),
            sum(m is None for m, _ in pairs),
        ],
        "fits off by": round(float(np.mean([abs(m.fits - t.fits) for m, t in both])), 3),
        "width off by, median and 90 %, m": [
            round(float(q), 4) for q in np.percentile(widths, [50, 90])
        ],
        "clear, told and true": [round(float(clear.mean()), 3), round(float(true_clear.mean()), 3)],
        "clear or not, agreed": round(float(np.mean((clear >= CLEAR) == (true_clear > 0))), 3),
        "Brier of clear": round(float(np.mean((clear - true_clear) ** 2)), 4),
    }


def _whole(node: str, kind: str, around: Surroundings, kb: Any) -> dict[str, Grasp]:
    """Grasps of the whole node by what its kind affords, as if it were one for certain."""
    own = replace(around.nodes[node], belief={kind: 1.0}, affords={}, existence=1.0)
    around = replace(around, nodes={**around.nodes, node: own})
    region = Region(node, "thing", own.x, own.y, own.z, own.room, 1.0, True, "")
    return {g.grasp: g for g in grasps(kind, [region], around, kb) if g.part is None}


def _true_surroundings(places: TruePlaces) -> Surroundings:
    """All boxes of the truth as nodes: small things by number, what they stand on as supports."""
    nodes = {}
    for i, thing in enumerate(places.small):
        nodes[f"small-{i}"] = _node(f"small-{i}", thing, thing["on"])
    for thing in places.large:
        nodes[thing["name"]] = _node(thing["name"], thing, None)
    return Surroundings(nodes)


def _node(id_: str, thing: Mapping[str, Any], on: str | None) -> Node:
    x, y = thing["xy"]
    a, b = thing["extent"]
    low, high = thing["bottom"], thing["top"]
    middle, size = (low + high) / 2, (a, b, high - low)
    return Node(id_, "ObservedEntity", x, y, middle, 1.0, {}, None, on, size, thing["yaw"])
