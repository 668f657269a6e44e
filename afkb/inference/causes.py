"""What is found together oftener than rooms explain, as causes of a noisy-OR."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, replace

import numpy as np

from afkb.inference.bands import Array
from afkb.inference.holdings import Holdings, Stated
from afkb.knowledge import ObjectWithObject

SHARED = 0.5
"""Part of its strength that each cause keeps where a category has several: what is met with a third
is mostly met together, and in part says the same. From 0.35 to 0.65 it hardly matters."""
_BISECTIONS = 40


@dataclass(frozen=True, slots=True)
class Cause:
    """Where `source` is found, `effect` is found by it with probability 1 - exp(-`hazard`).

    `source`, `effect`: indexes of categories, the source the rarer. `log_left`: log of what this
    cause leaves of the hazard by the room, which would else explain the same finds twice.
    `statements`: names of those of the ontology that say so.
    """

    source: int
    effect: int
    hazard: float
    log_left: float
    statements: tuple[str, ...]


def causes_of(holdings: Holdings, hazard: Array, stated: Stated) -> tuple[Cause, ...]:
    """The causes, by effect: each as strong as makes the two as often together as is stated.

    `hazard`: (C, R) of the rooms. Where two figures state it, one each way, their mean. What the
    rooms explain is no cause.
    """
    states = -np.expm1(-hazard[:, :, None] * np.array(stated.shares))
    weights = np.repeat(holdings.prior[:, None] / len(stated.shares), len(stated.shares), axis=1)
    found, w = states.reshape(len(hazard), -1), weights.ravel()
    alone = []
    for (source, effect), (joint, names) in _together(holdings, stated, found @ w).items():
        solved = _solved(found[source], found[effect], w, joint)
        if solved:
            alone.append(Cause(source, effect, *solved, names))
    several = np.bincount([c.effect for c in alone], minlength=len(hazard)) > 1
    kept = [
        replace(c, hazard=SHARED * c.hazard, log_left=SHARED * c.log_left)
        if several[c.effect]
        else c
        for c in alone
    ]
    return tuple(sorted(kept, key=lambda c: (c.effect, c.source)))


def _together(
    holdings: Holdings, stated: Stated, rate: Array
) -> dict[tuple[int, int], tuple[float, tuple[str, ...]]]:
    """P(both in a room) by (rarer, commoner), with the statements that say so."""
    at = {name: i for i, name in enumerate(holdings.categories)}
    said: defaultdict[tuple[int, int], list[tuple[float, ObjectWithObject]]] = defaultdict(list)
    for figure in stated.together:
        if figure.category in at and figure.given in at and figure.category != figure.given:
            category, given = at[figure.category], at[figure.given]
            rarer, commoner = sorted((category, given), key=lambda i: (rate[i], i))
            said[rarer, commoner].append((figure.probability * rate[given], figure))
    return {
        pair: (sum(p for p, _ in figures) / len(figures), tuple(f.name for _, f in figures))
        for pair, figures in said.items()
    }


def _solved(
    source: Array, effect: Array, weights: Array, joint: float
) -> tuple[float, float] | None:
    """The cause's hazard, and log of what is left of the rooms'; None where rooms explain it.

    `source`, `effect`, `weights`: (Z,) probabilities in each state of the hidden variables.
    """
    p_source, p_effect = float(weights @ source), float(weights @ effect)
    by_rooms = float(weights @ (source * effect))
    joint = min(joint, 0.98 * p_source, 0.98 * p_effect)
    if joint <= by_rooms:
        return None
    without = (p_effect - joint) / (1.0 - p_source)
    hazard = -np.log1p(-effect)
    there, not_there = weights * source / p_source, weights * (1.0 - source) / (1.0 - p_source)
    low, high = -6.0, 0.0
    for _ in range(_BISECTIONS):
        middle = (low + high) / 2.0
        if float(not_there @ -np.expm1(-np.exp(middle) * hazard)) < without:
            low = middle
        else:
            high = middle
    none = float(there @ np.exp(-np.exp(high) * hazard))
    return max(float(np.log(none / (1.0 - joint / p_source))), 0.0), high
