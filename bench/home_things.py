"""Things of a recorded home's truth with the nodes of a map that are them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from shapely import affinity
from shapely.geometry import Polygon, box

from bench.beliefs import MEANT, word_of
from bench.homes import NO_SUPPORT, RUNS, WELL_SEEN_PIXELS, WELL_SEEN_TOP_PIXELS

SAME_PLACE = 0.25
"""From this intersection over union of outlines on a node may be a thing: each is seen in part."""
WITHIN_RUN = 0.7
"""From this share of its outline in a node on a thing is part of a run that the node is."""
SAME_TOP_M = 0.06
SAME_RISE = 0.5
"""A node that is no surface shares this part of its height, or of the thing's, with the thing."""


@dataclass(frozen=True)
class Pair:
    """A thing of the truth that was seen well, and the node that is it, None where none is."""

    thing: dict[str, Any]
    word: str
    node: dict[str, Any] | None


def seen_well(thing: dict[str, Any]) -> bool:
    """Whether views show enough of a thing: of its top, if it is a support, else of itself."""
    if thing["movable"] and thing["on"]:
        return bool(thing["most_pixels"] >= WELL_SEEN_PIXELS)
    return bool(thing["top_pixels"] >= WELL_SEEN_TOP_PIXELS)


def pairs(nodes: list[dict[str, Any]], truth: dict[str, Any]) -> list[Pair]:
    """Every well-seen thing of a word that we have, with the node that covers it best."""
    found = []
    for thing in truth["things"]:
        word = word_of(thing)
        if word in MEANT and word not in NO_SUPPORT and seen_well(thing):
            rated = [(overlap(node, thing, word), node) for node in nodes]
            best = max(rated, key=lambda pair: pair[0], default=(0.0, None))
            found.append(Pair(thing, word, best[1] if best[0] > 0 else None))
    return found


def overlap(node: dict[str, Any], thing: dict[str, Any], word: str) -> float:
    """Intersection over union of the outlines where node and thing may be one, else 0."""
    if not same_height(node, thing, word):
        return 0.0
    outline = outline_of(node)
    true = box(*thing["min"][:2], *thing["max"][:2])
    shared = outline.intersection(true).area
    union = outline.area + true.area - shared
    in_run = word in RUNS and shared >= WITHIN_RUN * true.area
    alike = shared >= SAME_PLACE * union
    return float(shared / union) if in_run or alike else 0.0


def outline_of(node: dict[str, Any]) -> Polygon:
    """The rectangle of a node, in the frame of its position."""
    length, width = node["size"][:2]
    flat = box(-length / 2, -width / 2, length / 2, width / 2)
    turned = affinity.rotate(flat, node["yaw"], origin=(0, 0), use_radians=True)
    return affinity.translate(turned, node["x"], node["y"])


def same_height(node: dict[str, Any], thing: dict[str, Any], word: str) -> bool:
    """Whether a surface lies at a thing's top, or what is none rises as a thing does."""
    low, high = thing["min"][2], thing["max"][2]
    if "SupportAbility" in node["affords"]:
        if word.startswith("shelf"):
            return bool(low <= node["z"] <= high + SAME_TOP_M)
        return bool(abs(node["z"] - thing["top_height"]) <= SAME_TOP_M)
    rise = np.array([node["z"] - node["size"][2] / 2, node["z"] + node["size"][2] / 2])
    shared = min(rise[1], high) - max(rise[0], low)
    return bool(shared >= SAME_RISE * max(min(node["size"][2], high - low), 1e-3))
