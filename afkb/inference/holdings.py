"""How often rooms hold things, as a table: what figures state, and what they leave unsaid."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from afkb.inference.bands import Array
from afkb.knowledge import UNKNOWN_ROOM, AfNet, ObjectInRoom, ObjectWithObject

SMOOTHED_BY = 8.0
"""Rooms' worth of the rate anywhere in a figure that nobody states, as in one that is counted."""
LEAST, MOST = 1e-5, 0.995
"""No room is sure to hold a thing, or sure not to."""


@dataclass(frozen=True, slots=True)
class Stated:
    """What is known of homes, from an ontology or from counts.

    - `rooms`: room category to how many a home has, `UnknownRoom` among them or not.
    - `categories`: object category to how many a home has: the rate of what no figure names.
    - `stray`: share of the things told of a room that are of another, seen through a door.
    """

    rooms: Mapping[str, float]
    categories: Mapping[str, float]
    in_rooms: tuple[ObjectInRoom, ...]
    together: tuple[ObjectWithObject, ...]
    shares: tuple[float, ...]
    stray: float

    @classmethod
    def of(cls, kb: AfNet) -> Stated:
        """What a knowledge base states."""
        return cls(
            rooms={name: room.expected_number for name, room in kb.rooms.items()},
            categories={name: c.expected_number for name, c in kb.categories.items()},
            in_rooms=kb.objects_in_rooms,
            together=kb.objects_with_objects,
            shares=shares_of(kb),
            stray=kb.parameters["StrayShare"],
        )


@dataclass(frozen=True, slots=True, eq=False)
class Holdings:
    """What rooms hold; (C,) categories, (R,) rooms.

    `prior`: (R,) share of rooms. `probability`: (C, R) that a room holds such a thing, as somebody
    who lists its things finds it. `number`: (C, R) how many it then has, 1 or more.
    """

    categories: tuple[str, ...]
    rooms: tuple[str, ...]
    prior: Array
    probability: Array
    number: Array

    @classmethod
    def compile(cls, stated: Stated) -> Holdings:
        """Tables of what is stated; a pair that isn't has what smoothing leaves of the base rate.

        A room of unknown category is like the others on average.
        """
        rooms, categories = tuple(stated.rooms), tuple(stated.categories)
        prior = np.array([stated.rooms[room] for room in rooms])
        known = np.array([room != UNKNOWN_ROOM for room in rooms], dtype=np.bool_)
        weights = np.where(known, prior, 0.0) / prior[known].sum()
        p, mean = _figures(stated, categories, rooms, weights)
        base, number = p @ weights, mean @ weights
        p[:, ~known], mean[:, ~known] = base[:, None], number[:, None]
        p = (1.0 - stated.stray) * p + stated.stray * base[:, None]
        mean = (1.0 - stated.stray) * mean + stated.stray * number[:, None]
        held = np.clip(p, LEAST, MOST)
        return cls(categories, rooms, prior / prior.sum(), held, np.maximum(mean / held, 1.0))


def shares_of(kb: AfNet) -> tuple[float, ...]:
    """How much of a room's things may have been found: a hidden variable with an even prior."""
    return tuple(kb.parameters[f"ShareSeen{much}"] for much in ("Little", "Half", "Most"))


def _figures(
    stated: Stated, categories: tuple[str, ...], rooms: tuple[str, ...], weights: Array
) -> tuple[Array, Array]:
    """(C, R) probabilities and mean numbers."""
    row = {name: i for i, name in enumerate(categories)}
    column = {name: i for i, name in enumerate(rooms)}
    p = np.full((len(row), len(column)), np.nan)
    mean = np.full_like(p, np.nan)
    trials = np.zeros_like(weights)
    for figure in stated.in_rooms:
        if figure.category in row and figure.room in column:
            at = row[figure.category], column[figure.room]
            p[at] = figure.probability
            mean[at] = max(figure.mean_number, figure.probability)
            trials[at[1]] = max(trials[at[1]], figure.trials)
    _fill(p, mean, stated, trials, weights)
    return p, mean


def _fill(p: Array, mean: Array, stated: Stated, trials: Array, weights: Array) -> None:
    """What isn't stated: where some rooms are, the rate anywhere, met in none of the trials.

    Where none is, the number that a home has, spread evenly over its rooms.
    """
    in_home = sum(n for room, n in stated.rooms.items() if room != UNKNOWN_ROOM)
    anywhere = np.array([n / in_home for n in stated.categories.values()])
    named: NDArray[np.bool_] = np.asarray(np.isfinite(p).any(axis=1))
    base = np.where(named, np.nan_to_num(p) @ weights, -np.expm1(-anywhere))
    share = np.where(named[:, None], SMOOTHED_BY / (SMOOTHED_BY + trials), 1.0)
    left = base[:, None] * share
    missing: NDArray[np.bool_] = np.isnan(p)
    p[missing] = left[missing]
    mean[missing] = np.maximum(p, np.where(named[:, None], p, anywhere[:, None]))[missing]


def found_by_room(probability: Array, shares: tuple[float, ...]) -> Array:
    """(C, R) hazards, whole room seen, so that rooms of all shares together hold what is stated.

    P(found | share s) = 1 - exp(-s hazard): each thing is found with probability s, and there are
    Poisson many. What is stated is the mean over shares; solved by Newton steps.
    """
    target = -np.log1p(-probability)
    hazard = target / np.mean(shares)
    s = np.array(shares)
    for _ in range(30):
        none = np.exp(-hazard[..., None] * s)
        mean = 1.0 - none.mean(axis=-1)
        slope = (none * s).mean(axis=-1)
        # Newton in the hazard, kept positive.
        hazard = np.maximum(hazard + (probability - mean) / slope, hazard / 4.0)
    return np.asarray(hazard)


def kinds_together(holdings: Holdings, kinds: Iterable[str]) -> Holdings:
    """The same of kinds of things: `kinds` (C,) names what each category is, of all it can be."""
    of = list(kinds)
    names = tuple(sorted(set(of)))
    member = np.array([[kind == name for kind in of] for name in names], dtype=np.float64)
    none = np.log1p(-holdings.probability)
    p = np.clip(-np.expm1(member @ none), LEAST, MOST)
    mean = member @ (holdings.probability * holdings.number)
    return Holdings(names, holdings.rooms, holdings.prior, p, np.maximum(mean / p, 1.0))
