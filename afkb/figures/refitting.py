"""Figures of homes of one's own: what others' homes hold is but where they begin."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from afkb.figures.figure import InRoom
from afkb.figures.figures import Figures
from afkb.figures.smoothing import ROOM_WEIGHT, beta_mean, gamma_mean


def refitted(general: Figures, own: Figures) -> Iterator[InRoom]:
    """What rooms of one's own hold, for every category and room that was met in them.

    Homes of one kind differ from others more than they do among each other. So their figures are
    Beta and Gamma-Poisson means about the general ones, which count for `ROOM_WEIGHT` rooms, as the
    rate anywhere does in these; not sums of both, in which a few homes would be lost among many
    (`python -m bench.inference learning`). `successes` and `trials` are those of one's own.
    """
    known = set(general.categories())
    for place in own.in_rooms(least=0):
        if place.category in known:
            yield _about(place, general)
        else:
            yield place


def _about(place: InRoom, general: Figures) -> InRoom:
    before = general.object_in_room(place.category, place.room)
    number = general.number_in_room(place.category, place.room)
    own, own_number = place.figure, place.number
    p = beta_mean(own.successes, own.trials, before.p, ROOM_WEIGHT)
    mean = gamma_mean(own_number.things, own_number.rooms, number.mean, ROOM_WEIGHT)
    source = f"{own.source}, about the figures of {before.source}"
    return replace(
        place,
        figure=replace(own, p=p, source=source),
        number=replace(own_number, mean=mean, source=source),
    )
