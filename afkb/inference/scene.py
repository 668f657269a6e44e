"""What the things of a room are, all together: room → category, and support ↔ what it carries."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from afkb.errors import EvidenceError
from afkb.inference.bands import Array
from afkb.inference.placement import PlacementNetwork

Carriers = Sequence[int | None]
"""For each thing the index of the one that carries it, None where there is none."""
CERTAIN_LOG = 300.0
"""Greatest logarithm of a ratio of odds: sure beyond doubt, and finite under an exponential."""


@dataclass(frozen=True, slots=True, eq=False)
class Recognised:
    """What the things (N) of a room are, of C categories, and what the room is for.

    - `shares`: (N, C), P(category | all that was seen).
    - `room`: (R,), P(room category | all that was seen).
    - `context`: (N,), how many times likelier the evidence of a thing is in its surroundings than
      anywhere: by which the odds that it exists rise or fall (paper §II.C).
    """

    shares: Array
    room: Array
    context: Array


def recognise(
    placement: PlacementNetwork, prior: Array, evidence: Array, on: Carriers, room: Array
) -> Recognised:
    """Exact posteriors by message passing from leaves to roots and back, in all rooms at once.

    `prior`: (C,) of categories anywhere; `evidence`: (N, C), likelihood of what was seen of each
    thing; `room`: (R,), belief from what else is known of the room. Given the room, things depend
    on each other but through who carries whom, which is a forest. Equal to variable elimination
    (tested). Raises `EvidenceError` where things carry each other or evidence is impossible.
    """
    order = leaves_first(on)
    with np.errstate(divide="ignore"):
        inside = np.log(evidence)[:, :, None] + np.log(placement.in_room)[None]
    said = np.zeros_like(inside)
    totals = np.zeros((len(on), len(room)))
    for i in order:
        totals[i] = _log_sum(inside[i])
        carrier = on[i]
        if carrier is not None:
            said[i] = _expected(placement.carries, inside[i])
            inside[carrier] += said[i]
    outside = np.zeros_like(inside)
    for i in reversed(order):
        carrier = on[i]
        if carrier is not None:
            rest = inside[carrier] + outside[carrier] - said[i]
            outside[i] = _expected(placement.is_carried, rest)
    return _told(prior, evidence, room, inside + outside, totals.sum(axis=0))


def _told(prior: Array, evidence: Array, room: Array, joint: Array, log_room: Array) -> Recognised:
    """Posteriors from `joint` (N, C, R), logarithms, and the things' evidence of the room (R,)."""
    with np.errstate(divide="ignore", invalid="ignore"):
        now = _shares(np.log(room) + log_room)
        with_it = _log_sum(joint, axis=1)
        within = np.exp(joint - np.where(np.isfinite(with_it), with_it, 0.0)[:, None, :])
        # Without the thing its room is a little less likely: a harmonic mean over the rooms.
        without = np.log(now)[None] - with_it
        context = -_log_sum(np.where(now > 0, without, -np.inf), axis=1)
        context -= np.log(evidence @ prior)
    return Recognised(within @ now, now, np.exp(np.clip(context, -CERTAIN_LOG, CERTAIN_LOG)))


def leaves_first(on: Carriers) -> list[int]:
    """An order in which everything comes before what carries it; `EvidenceError` for a circle."""
    waiting = [0] * len(on)
    for i, carrier in enumerate(on):
        if carrier is not None:
            if not 0 <= carrier < len(on):
                raise EvidenceError(f"thing {i} stands on thing {carrier}, of {len(on)} things")
            waiting[carrier] += 1
    ready = [i for i, n in enumerate(waiting) if not n]
    for i in ready:
        carrier = on[i]
        if carrier is not None:
            waiting[carrier] -= 1
            if not waiting[carrier]:
                ready.append(carrier)
    if len(ready) < len(on):
        circle = sorted(set(range(len(on))) - set(ready))
        raise EvidenceError(
            f"things {circle} carry each other; one of them stands on something else"
        )
    return ready


def _expected(of: Callable[[Array], Array], logs: Array) -> Array:
    """Logarithm of what a table is on average (C, R), under weights with logarithms (C, R)."""
    return np.asarray(np.log(of(_shares(logs))))


def _shares(logs: Array) -> Array:
    """Weights of these logarithms, summing to 1 along the first axis."""
    total = _log_sum(logs)
    if not np.isfinite(total).any():
        raise EvidenceError("no category or room can hold what was seen; check for strengths of 0")
    return np.asarray(np.exp(logs - np.where(np.isfinite(total), total, 0.0)))


def _log_sum(logs: Array, axis: int = 0) -> Array:
    return np.asarray(np.logaddexp.reduce(logs, axis=axis))
