"""Where in a home's map its small things truly are: of a home with its truth."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import cv2
import numpy as np

from afkb.finding import Node, Surroundings
from afkb.store import load
from afkb.store.vocabulary import local_name
from afkb_mapping.geometry import yaw_of
from bench.mapping.true_views import T_map_world

Thing = Mapping[str, Any]

ASKED: Mapping[str, tuple[str, ...]] = {
    "Cup": ("cups", "mug"),
    "Mug": ("mug",),
    "Bowl": ("bowl",),
    "Pitcher": ("pitcher_base",),
    "Can": ("master_chef_can",),
    "Bottle": ("mustard_bottle", "bleach_cleanser"),
    "FoodPack": ("cracker_box", "pudding_box", "sugar_box"),
    "Plaything": ("rubiks_cube",),
}
"""What is asked for, and the truth's words for it."""
WITHIN_M = 0.05
HEIGHT_WITHIN_M = 0.08
"""A thing stands on a support whose top is this near to its foot: a run of cabinets is uneven."""


@dataclass(frozen=True, slots=True, eq=False)
class TruePlaces:
    """A map with its home's small things, and all others; `outlines`: (N, 1, 2) of rooms, m."""

    around: Surroundings
    small: tuple[Thing, ...]
    large: tuple[Thing, ...]
    outlines: Mapping[str, Any]

    @classmethod
    def of(cls, home: Path, folder: Path) -> TruePlaces:
        """Those of a home that was mapped into a folder, in the frame of the map."""
        truth = json.loads((home / "truth.json").read_text())
        stored, T = load(folder), T_map_world(truth)
        rooms = {local_name(r.value): stored.outline(r) for r in stored.instances("Room")}
        return cls(
            Surroundings.of(stored),
            tuple(_moved(thing, T) for thing in truth["things"] if thing["on"]),
            tuple(_moved(thing, T) for thing in truth["things"] if not thing["on"]),
            {k: np.array(xy, np.float32)[:, None] for k, xy in rooms.items() if xy},
        )

    def things(self, category: str) -> list[Thing]:
        """The things that are meant by what is asked for."""
        return [thing for thing in self.small if thing["word"] in ASKED[category]]

    def region_of(self, thing: Thing, around: Surroundings) -> tuple[str, str]:
        """Node and kind of the region that is its place: its own, its support's, its room's."""
        if own := self.node_of(thing, around):
            return own, "thing"
        on = [n for n in around.nodes.values() if n.supports and _stands_on(thing, n)]
        if on:
            return min(on, key=lambda n: (not n.seen, n.size[0] * n.size[1], n.id)).id, "support"
        return min(self.outlines, key=lambda room: self._outside(room, thing), default=""), "room"

    def node_of(self, thing: Thing, around: Surroundings) -> str | None:
        """The node of a map that lies in the thing's box, if there is one; a support is none."""
        inside = [
            n
            for n in around.nodes.values()
            if n.seen
            and not n.supports
            and math.dist((n.x, n.y), thing["xy"]) <= thing["radius"] + WITHIN_M
            and thing["bottom"] - WITHIN_M <= n.z <= thing["top"] + WITHIN_M
        ]
        near = min(inside, key=lambda n: math.dist((n.x, n.y), thing["xy"]), default=None)
        return near.id if near else None

    def _outside(self, room: str, thing: Thing) -> float:
        x, y = thing["xy"]
        return -float(cv2.pointPolygonTest(self.outlines[room], (float(x), float(y)), True))


def _moved(thing: Thing, T: Any) -> Thing:
    """A thing of the truth in the map's frame: its middle, its box, half of its longer side."""
    low, high = np.array(thing["min"]), np.array(thing["max"])
    middle = T @ [*(low[:2] + high[:2]) / 2, 0.0, 1.0]
    return {
        "name": thing["name"],
        "on": thing["on"],
        "extent": tuple((high - low)[:2].tolist()),
        "yaw": yaw_of(T),
        "word": re.sub(r"^\d+(-\w)?_", "", thing["category"]),
        "xy": (float(middle[0]), float(middle[1])),
        "radius": float((high - low)[:2].max()) / 2,
        "bottom": float(low[2]),
        "top": float(high[2]),
    }


def _stands_on(thing: Thing, node: Node) -> bool:
    """Whether its middle lies on the node's rectangle and its foot at the node's height."""
    if abs(thing["bottom"] - node.z) > HEIGHT_WITHIN_M:
        return False
    dx, dy = thing["xy"][0] - node.x, thing["xy"][1] - node.y
    c, s = math.cos(node.yaw), math.sin(node.yaw)
    along = abs(c * dx + s * dy), abs(c * dy - s * dx)
    return all(a <= extent / 2 + WITHIN_M for a, extent in zip(along, node.size, strict=False))
