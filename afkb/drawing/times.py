"""When the map was made: its beginning and end, its visits, and where the robot was."""

from __future__ import annotations

import numpy as np

from afkb.drawing.facts import Json
from afkb.drawing.layers import stamped_way
from afkb.flow import TopologicalMap

VISIT_GAP_S = 600.0
"""A robot of which nothing is known for so long has been away: it comes for another visit."""


def times_of(m: TopologicalMap) -> Json:
    """`start`, `end` (s, the map's clock), `visits`: [start, end] of each, `way`: [s, x, y] (m).

    What a node was at a time follows from its own facts: `first_seen`, `last_seen`, `steps`.
    """
    stamps = [place.stamp for place in m.places]
    stamps += [stamp for e in m.entities for stamp in (e.first_seen, e.last_seen)]
    stamps += [stamp for p in m.past_predictions for stamp in (p.first_seen, p.ended)]
    stamps += m.trajectory[:, 0].tolist() if len(m.trajectory) else []
    known = np.unique(np.array([s for s in stamps if np.isfinite(s)], dtype=np.float64))
    if not known.size:
        return {"start": 0.0, "end": 0.0, "visits": [], "way": []}
    breaks = np.nonzero(np.diff(known) > VISIT_GAP_S)[0]
    starts = known[np.concatenate(([0], breaks + 1))]
    ends = known[np.concatenate((breaks, [len(known) - 1]))]
    way = stamped_way(m.trajectory)
    return {
        "start": round(float(known[0]), 3),
        "end": round(float(known[-1]), 3),
        "visits": [[round(a, 3), round(b, 3)] for a, b in zip(starts, ends, strict=True)],
        "way": np.round(way, 3).tolist(),
    }
