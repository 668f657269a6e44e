"""The truth of a world in the form in which any recording's truth is told."""

from __future__ import annotations

import math

from afkb.flow import TrueThing, TrueView, Truth
from afkb_mapping.geometry import yaw_of
from afkb_simulation.reading import read_world
from afkb_simulation.truth import TrueThing as WorldThing
from afkb_simulation.truth import WorldTruth, load_truth


def known_truth(uri: str) -> Truth:
    """The truth of the world behind a path or `world:NAME`; `SourceError` where it can't be read.

    Its frame is the world's; its stamps are the recording's.
    """
    truth, frame_s = load_truth(uri), read_world(uri).tour.frame_s
    return Truth(
        tuple(_view(truth, index, frame_s) for index in range(len(truth.T_world_base))),
        tuple(_thing(thing, truth, frame_s) for thing in truth.things.values()),
        {room.name: room.category for room in truth.rooms.values()},
    )


def _view(truth: WorldTruth, index: int, frame_s: float) -> TrueView:
    T = truth.T_world_base[index]
    stamp = round(index * frame_s, 6)
    return TrueView(stamp, float(T[0, 3]), float(T[1, 3]), yaw_of(T), truth.frame_rooms[index])


def _thing(thing: WorldThing, truth: WorldTruth, frame_s: float) -> TrueThing:
    last = max(thing.frames, default=0)
    gone = thing.dynamic and last < len(truth.T_world_base) - 1
    until = round(last * frame_s, 6) if gone else math.inf
    return TrueThing(thing.name, thing.category, thing.box, thing.room, until)
