"""Loops as the map states them: with the places of the robot that their views were taken in."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from afkb.flow import LoopProposal, TopologicalMap
from afkb_mapping.loops.closing import ClosedLoops


def with_loops(found: TopologicalMap, closed: ClosedLoops) -> TopologicalMap:
    """The map with what closing loops came to: proposals, and how many of each kind there were."""
    accepted = sum(p.accepted for p in closed.proposals)
    counts = {
        "loops_closed": accepted,
        "loops_rejected": len(closed.proposals) - accepted,
        "loops_confirmed": closed.confirmed,
    }
    return replace(
        found,
        loops=tuple(_placed(closed.proposals, found)),
        counts={**found.counts, **counts},
    )


def _placed(proposals: Sequence[LoopProposal], found: TopologicalMap) -> list[LoopProposal]:
    if not found.places or not len(found.trajectory):
        return list(proposals)
    stamps, at = found.trajectory[:, 0], found.trajectory[:, [4, 8]]
    places = np.array([(p.x, p.y) for p in found.places])

    def place_at(stamp: float) -> str:
        xy = at[int(np.argmin(np.abs(stamps - stamp)))]
        return found.places[int(np.argmin(np.hypot(*(places - xy).T)))].id

    return [
        replace(p, place=place_at(p.stamp), earlier_place=place_at(p.earlier_stamp))
        for p in proposals
    ]
