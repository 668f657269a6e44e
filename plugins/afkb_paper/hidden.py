"""Whether a robot that plans on the map keeps clear of what it has not seen yet (paper §III).

"With a traditional topological map the obstacle marked in red in row 1 is not identified resulting
in possible collisions with the obstacle."
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from afkb.flow import NodeKind, PastPrediction, PredictionState, TopologicalMap, TrueThing
from afkb.store.stored_grid import StoredGrid
from afkb_paper.judged import Judged
from afkb_paper.outlines import outline
from afkb_paper.passing import Passing, points_around, ways_between
from afkb_paper.steps import Steps, moments

if TYPE_CHECKING:
    from shapely import Polygon

Array = NDArray[np.float64]

LEAST_TOP_M = 0.3
"""A way leads round what is higher; what is lower is a step or a carpet to a robot."""


@dataclass(frozen=True, slots=True, eq=False)
class Hidden:
    """A thing that was expected before it was seen, and ways past it on the map of that time.

    - `probability`: of it, before it was seen. `off_m`: from where it was expected to where it is.
    - `expecting`, `blind`: the ways past it on the map with what is expected, and without.
    - `map_then`: the former.
    """

    thing: TrueThing
    outline: Polygon
    probability: float
    off_m: float
    expecting: Passing
    blind: Passing
    map_then: TopologicalMap

    @property
    def avoided(self) -> bool:
        """Whether ways that would lead through it no longer do."""
        return self.expecting.hits == 0 < self.blind.hits

    @property
    def worst(self) -> int:
        """Which of the ways leads farthest through it without what is expected."""
        return int(np.argmax(self.blind.within_m))


def hidden_things(judged: Judged, steps: Steps, stored: StoredGrid) -> list[Hidden]:
    """Each thing that was expected by duality, then seen, that a robot can drive past.

    `stored`: the whole map's grid, with the thresholds by which its cells are free or occupied.
    """
    found: dict[str, Hidden] = {}
    for past in judged.found.past_predictions:
        thing = _thing_of(past, judged)
        if thing is not None and thing.name not in found:
            hidden = _past(past, thing, judged, steps, stored)
            found |= {thing.name: hidden} if hidden else {}
    return list(found.values())


def _past(
    past: PastPrediction, thing: TrueThing, judged: Judged, steps: Steps, stored: StoredGrid
) -> Hidden | None:
    at = outline(judged.box(thing))
    points = points_around(at, judged.found.trajectory[:, (4, 8)])
    if len(points) < 2:
        return None
    then = _moment(past, judged, steps)
    expecting, blind = steps.until(then), steps.until(then, predicting=False)
    off = float(np.hypot(*np.subtract(past.position_xyz[:2], judged.box(thing).center_xyz[:2])))
    return Hidden(
        thing,
        at,
        past.probability,
        off,
        ways_between(points, expecting.grid, stored, at),
        ways_between(points, blind.grid, stored, at),
        expecting,
    )


def _moment(past: PastPrediction, judged: Judged, steps: Steps) -> float:
    """When the robot left the place from which it came to expect it, unless it was seen before."""
    left = (end for _, end in moments(judged.found) if end >= past.first_seen)
    return min(next(left), steps.before(past.ended))


def _thing_of(past: PastPrediction, judged: Judged) -> TrueThing | None:
    """The true thing that a confirmed dual became: the nearest in height in whose box it lies."""
    if past.state is not PredictionState.CONFIRMED or past.kind != NodeKind.DUAL.value:
        return None
    node = next((e for e in judged.found.entities if e.id == past.seen_as), None)
    if node is None:
        return None
    import shapely

    at = shapely.Point(node.position_xyz[:2])
    high: Sequence[TrueThing] = [
        t for t in judged.truth.things if t.box.top > LEAST_TOP_M > t.box.bottom
    ]
    around = [t for t in high if outline(judged.box(t)).contains(at)]
    return min(around, key=lambda t: abs(t.box.top - node.top_m), default=None)
