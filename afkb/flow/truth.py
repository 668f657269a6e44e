"""What is so where a recording was made, as plain data: maps are judged by it, never made of it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from afkb.flow.detection import OrientedBox


@dataclass(frozen=True, slots=True)
class TrueView:
    """Where the robot's base was at a moment: stamp (s), x, y (m), yaw (rad), and its room."""

    stamp: float
    x: float
    y: float
    yaw: float
    room: str | None = None


@dataclass(frozen=True, slots=True)
class TrueThing:
    """A thing as it is, in the frame of the true views.

    `category`: the ontology's name where it has one, else the truth's own word; `room`: its name;
    `until`: stamp of the last view before it was moved or taken away, s.
    """

    name: str
    category: str
    box: OrientedBox
    room: str | None = None
    until: float = math.inf


@dataclass(frozen=True, slots=True, eq=False)
class Truth:
    """Everything that a map can be judged by.

    - `views`: by stamp. `rooms`: name to room category.
    - The frame has z up and the floor at 0; where its origin is does not matter.
    """

    views: tuple[TrueView, ...]
    things: tuple[TrueThing, ...] = ()
    rooms: Mapping[str, str] = field(default_factory=dict)
