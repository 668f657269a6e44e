"""Whether two observations may be of one thing, by what they afford and may then be."""

from __future__ import annotations

import numpy as np

from afkb.errors import EvidenceError
from afkb.flow import Detection
from afkb.inference import Network
from afkb_mapping.things.tracks import ObservedTrack

LEAST_ALIKE = 0.03
"""Bhattacharyya coefficient of two posteriors over what a thing is, below which they hardly share a
category. Views of a part see other affordances than views of the whole, so only what next to
excludes each other is kept apart."""


def same_kind(track: ObservedTrack, detection: Detection, network: Network) -> bool:
    """Whether the posteriors of a track and of a detection near it share a category.

    From what each affords, its size and the height of its top; a size that isn't known for sure is
    a lower bound. What the network has no word for, it excludes nothing of.
    """
    low, high = track.footprint.box()
    top, height = track.top.value, max(track.top.value - track.bottom.value, 0.0)
    length, width = (float(v) for v in high - low)
    affords = network.known(track.affordances)
    try:
        known = network.objects.shares(affords, (length, width, height), top, track.extent_known)
        seen = network.objects.shares(
            network.known(detection.affordances),
            detection.box.size_xyz,
            detection.box.top,
            detection.seen_whole,
        )
    except EvidenceError:
        return True
    return float(np.sqrt(known * seen).sum()) >= LEAST_ALIKE
