"""Figures of some homes about those of others: what is rare here is told by how it is there."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from afkb.errors import KnowledgeError
from afkb.figures import Figures
from afkb.figures.figure import Figure, InRoom, Rate
from afkb.figures.smoothing import beta_mean

ROOMS_BEHIND = 30.0
"""How many rooms of the homes asked about the figures of others count for, beside theirs.

Chosen on held-out buildings (`python -m bench.inference rooms`): from 20 to 60 it hardly matters.
"""


def in_rooms_about(
    own: Figures, others: Figures, rooms: Sequence[str], weight: float = ROOMS_BEHIND
) -> Iterator[InRoom]:
    """Every category that `own` has a name of, in each of the rooms, drawn towards the others.

    The prior mean is the rate anywhere in these homes, shifted by the odds ratio between such a
    room and the mean of the rooms that others tell; where they don't know of it, the rate itself.
    """
    for category in own.categories():
        base = own.base_rate(category)
        there = [_odds(p) for room in rooms if (p := _known(others, category, room)) is not None]
        anywhere = math.fsum(there) / len(there) if there else 1.0
        numbers = [own.number_in_room(category, room) for room in rooms]
        figures = [own.object_in_room(category, room) for room in rooms]
        each = _number_where_any(numbers, figures)
        for room, figure, number in zip(rooms, figures, numbers, strict=True):
            p = _known(others, category, room)
            odds = _odds(base) * (_odds(p) / anywhere if p is not None else 1.0)
            prior = odds / (1.0 + odds)
            held = beta_mean(figure.successes, figure.trials, prior, weight)
            several = (number.things + weight / 6 * each) / (figure.successes + weight / 6)
            yield InRoom(
                category,
                room,
                Figure(held, figure.successes, figure.trials, figure.buildings, figure.source),
                Rate(held * several, number.things, number.rooms, number.buildings, number.source),
            )


def _known(figures: Figures, category: str, room: str) -> float | None:
    """The rate that these figures tell, if they have rooms of the kind and a name of the thing."""
    try:
        figure = figures.object_in_room(category, room)
    except KnowledgeError:
        return None
    return figure.p if figure.trials else None


def _number_where_any(numbers: Sequence[Rate], figures: Sequence[Figure]) -> float:
    """How many there are where there is any, over all rooms: 1 or more."""
    holding = math.fsum(f.successes for f in figures)
    return max(math.fsum(n.things for n in numbers) / holding, 1.0) if holding else 1.0


def _odds(p: float) -> float:
    return p / (1.0 - p)
