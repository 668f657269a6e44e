"""Tables of the object network: how often a category's things afford, measure and stand as seen."""

from __future__ import annotations

import numpy as np

from afkb.inference.bands import (
    TOP_EDGES_M,
    Array,
    board_bands,
    even_bands,
    size_bands,
    top_bands,
)
from afkb.knowledge import SOMETHING_ELSE, AfNet, Category

LENGTH, WIDTH, HEIGHT, TOP = "Length", "Width", "Height", "TopHeight"
BOARDS, DOOR = "Boards", "HingedDoor"
"""Traits of what is made of boards, and of what a door closes."""


def features(kb: AfNet, prior: Array) -> dict[str, Array]:
    """Feature to (C,) probability that a detector reports it on such a thing."""
    afbits = [_inherited(kb, c) for c in kb.categories.values()]
    used = sorted({f for bits in afbits for f in bits if kb.features[f].kind != "grasp"})
    leak, breadth = kb.parameters["AfbitLeak"], kb.parameters["UnknownBreadth"]
    other = np.array([name == SOMETHING_ELSE for name in kb.categories])
    known_prior = np.where(other, 0.0, prior)
    features: dict[str, Array] = {}
    for name in used:
        column = np.array([bits.get(name, leak) for bits in afbits])
        if known_prior.sum() > 0:
            mean = float(column @ known_prior / known_prior.sum())
            column[other] = (1.0 - breadth) * mean + breadth * 0.5
        features[name] = column
    return features


def _inherited(kb: AfNet, category: Category) -> dict[str, float]:
    """How often each feature is reported: the category's rates, else its afbits, else inherited."""
    bits: dict[str, float] = {}
    for name in kb.kinds_of(category.name):
        if name in kb.categories:
            kind = kb.categories[name]
            bits = {**kind.afbits, **kind.report_rates, **bits}
    return bits


def measures(kb: AfNet) -> dict[str, Array]:
    """Measure to (bands, C) probabilities, from typical sizes and heights."""
    spread, noise = kb.parameters["SizeSpread"], kb.parameters["SizeNoise"]
    blur = kb.parameters["SizeBlur"]
    categories = kb.categories.values()
    columns = {
        LENGTH: [size_bands(*c.length_m, spread, noise, blur) for c in categories],
        WIDTH: [size_bands(*c.width_m, spread, noise, blur) for c in categories],
        HEIGHT: [size_bands(*c.height_m, spread, noise, 0.0) for c in categories],
        TOP: [_tops(c, spread, kb.parameters["HeightNoise"]) for c in categories],
    }
    return {name: np.array(bands).T for name, bands in columns.items()}


def _tops(category: Category, spread: float, noise_m: float) -> Array:
    """Bands of the height of an upper surface: of open boards any may be the one that is seen."""
    if category.top_height_m is None:
        return even_bands(TOP_EDGES_M)
    if has_open_boards(category):
        return board_bands(category.top_height_m[1], noise_m)
    return top_bands(*category.top_height_m, spread, noise_m)


def has_open_boards(category: Category) -> bool:
    """Whether it is made of boards over each other that no door hides."""
    return BOARDS in category.traits and DOOR not in category.traits


def boards(kb: AfNet) -> Array:
    """P(a surface is seen over or under another of the same outline | category), (C,)."""
    seen, leak = kb.parameters["BoardsSeen"], kb.parameters["AfbitLeak"]
    return np.array([seen if has_open_boards(c) else leak for c in kb.categories.values()])


def broader_features(kb: AfNet, name: str) -> frozenset[str]:
    """All features that a feature is a narrower kind of."""
    found: list[str] = []
    broader = kb.features[name].broader
    while broader is not None:
        found.append(broader)
        broader = kb.features[broader].broader
    return frozenset(found)
