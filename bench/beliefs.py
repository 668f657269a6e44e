"""What a map of a recorded home takes its things and rooms for, beside the truth.

    python -m bench.beliefs MAP --truth truth.json [--json]

Things: of the observed nodes that lie in a thing whose category the ontology has, how often that
category, or a narrower one, is the first of the five that `map.json` names, how often one of the
five, and the mean probability of those among the five. Rooms: the views taken in each room of the
map, by the room of the truth, with the best three categories.
"""

from __future__ import annotations

import argparse
import json
import re
import sys
from collections import Counter
from collections.abc import Iterable
from pathlib import Path

import cv2
import numpy as np

from afkb.knowledge import AfNet
from afkb_mapping.geometry import T_from_xy_yaw
from bench.homes import in_world, nodes_of

CABINETS = ("Cupboard", "Counter")
SMALL_PACKS = ("Carton", "FoodPack", "Box")
MEANT = {
    "basket": ("Basket", "LaundryHamper"),
    "bathtub": ("Bathtub",),
    "bed": ("Bed",),
    "bleach_cleanser": ("CleanerBottle", "Detergent", "Bottle"),
    "bottom_cabinet": CABINETS,
    "bottom_cabinet_no_top": CABINETS,
    "bowl": ("Bowl",),
    "chair": ("Chair",),
    "coffee_table": ("CoffeeTable",),
    "cooktop": ("Stove", "Cooktop", "Counter"),
    "counter": ("Counter",),
    "cracker_box": SMALL_PACKS,
    "cups": ("Cup",),
    "dishwasher": ("Dishwasher", "Counter"),
    "dryer": ("ClothesDryer", "WashingMachine"),
    "fridge": ("Fridge",),
    "master_chef_can": ("Can", "Canister"),
    "microwave": ("Microwave",),
    "mug": ("Cup",),
    "mustard_bottle": ("Bottle",),
    "oven": ("Stove", "Oven", "Counter"),
    "pitcher_base": ("Pitcher", "Carafe"),
    "pudding_box": SMALL_PACKS,
    "shelf": ("Shelf", "WallShelf"),
    "sink": ("Sink", "VanityUnit"),
    "sofa_chair": ("Armchair",),
    "stool": ("Stool", "Footstool", "Ottoman"),
    "sugar_box": SMALL_PACKS,
    "table": ("Table",),
    "toilet": ("Toilet",),
    "top_cabinet": CABINETS,
    "trash_can": ("TrashCan",),
    "washer": ("WashingMachine",),
}
"""What the truth's words mean, broadest first; a run of base cabinets and machines is a counter."""
LOW_TABLES = ("CoffeeTable", "SideTable")
WITHIN_M, TOP_WITHIN_M = 0.04, 0.06


def meant(word: str, kb: AfNet) -> set[str]:
    """The ontology's categories that a word of the truth means, narrower ones included."""
    found = kinds_of(MEANT[word], kb)
    return found - set(LOW_TABLES) if word == "table" else found


def kinds_of(categories: Iterable[str], kb: AfNet) -> set[str]:
    """Categories with all narrower ones."""
    return {name for name in kb.categories if _chain(name, kb) & set(categories)}


def _chain(name: str | None, kb: AfNet) -> set[str]:
    chain: set[str] = set()
    while name in kb.categories and name not in chain:
        chain.add(name)
        name = kb.categories[name].broader
    return chain


def thing_of(node: dict, truth: dict) -> dict | None:
    """The smallest thing of the truth, of a word that we have, in whose box a node lies."""
    near = []
    for thing in truth["things"]:
        inside = all(
            low - WITHIN_M <= node[axis] <= high + WITHIN_M
            for axis, low, high in zip("xyz", thing["min"], thing["max"], strict=True)
        )
        board = "SupportAbility" in node["affords"] and not word_of(thing).startswith("shelf")
        if inside and not (board and abs(thing["top_height"] - node["z"]) > TOP_WITHIN_M):
            near.append(thing)
    near = [t for t in near if word_of(t) in MEANT]
    return min(near, key=_volume, default=None)


def word_of(thing: dict) -> str:
    return re.sub(r"^\d+(-\w)?_", "", thing["category"])


def _volume(thing: dict) -> float:
    return float(np.prod(np.subtract(thing["max"], thing["min"])))


def things(nodes: list[dict], truth: dict, kb: AfNet) -> dict:
    """Nodes in things of known words: how many are right at first, and among the five named."""
    counts, first, five, mass = Counter(), Counter(), Counter(), []
    for node in nodes:
        thing = thing_of(node, truth)
        if thing is None or ("SupportAbility" in node["affords"] and node["z"] < 0.08):
            continue
        word, right = word_of(thing), meant(word_of(thing), kb)
        named = sorted(node["category"], key=lambda name: -node["category"][name])
        counts[word] += 1
        first[word] += named[0] in right
        five[word] += bool(right.intersection(named))
        mass.append(sum(p for name, p in node["category"].items() if name in right))
    return {
        "nodes": counts.total(),
        "right at first": first.total(),
        "right among five": five.total(),
        "mean probability of the right ones": round(float(np.mean(mass)), 3),
        "by word: nodes, first, five": {w: (n, first[w], five[w]) for w, n in counts.items()},
    }


def rooms(folder: Path, truth: dict) -> dict:
    """Per room of the map: views in it by the truth's rooms, and its best three categories."""
    found = json.loads((folder / "map.json").read_text())["rooms"]
    names = {round(v["stamp"], 3): v["room"] for v in truth["views"]}
    views: dict[str, Counter] = {room["id"]: Counter() for room in found}
    for row in np.loadtxt(folder / "state" / "trajectory.txt", ndmin=2):
        nearest = min(found, key=lambda room: _outside(room, row[4], row[8]))
        views[nearest["id"]][names.get(round(row[0], 3))] += 1
    return {
        room["id"]: {
            "views": dict(views[room["id"]]),
            "taken for": dict(sorted(room["belief"].items(), key=lambda item: -item[1])[:3]),
        }
        for room in found
    }


def _outside(room: dict, x: float, y: float) -> float:
    outline = np.array(room["polygon"], np.float32)[:, None]
    return -cv2.pointPolygonTest(outline, (float(x), float(y)), True)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("map", type=Path)
    parser.add_argument("--truth", type=Path, required=True)
    parser.add_argument("--json", action="store_true")
    arguments = parser.parse_args()
    truth = json.loads(arguments.truth.read_text())
    start = truth["views"][0]
    nodes = in_world(nodes_of(arguments.map), T_from_xy_yaw(start["x"], start["y"], start["yaw"]))
    result = {**things(nodes, truth, AfNet.load()), "rooms": rooms(arguments.map, truth)}
    if arguments.json:
        json.dump(result, sys.stdout, indent=1)
        return 0
    for key, value in result.items():
        print(f"{key}: {value}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
