"""How often what was cut out of the image is one body, whole: by how it stands and what ends it."""

from __future__ import annotations

from afkb_mapping.bodies import Body, Stand

STANDING = {Stand.ON_SUPPORT: 1.0, Stand.HIDDEN: 0.5, Stand.ON_FLOOR: 0.4}
"""By what it stands on. Where the support is out of sight, parts of furniture and of walls look as
if they stood somewhere; on the floor legs, backs and sides of furniture are more than bins are."""
CUT = 0.5
"""Where the image edge cuts it, or its upper end lies beyond what was looked at."""
END_M = 0.02
"""A body whose top comes this near to the end of what was looked at goes on above it."""
ATTACHED = (0.08, 0.22)
"""Share of a body's outline beyond which its surface goes on: below the first it stands free,
above the second it is part of something larger."""
LENGTH_M = (0.6, 1.0)
"""Longer side of what is set down on a support: all below the first, nothing above the second;
what is longer is built in, or the wall."""


def wholeness(
    body: Body, height_m: float, highest_m: float, length_m: float, attached: float
) -> float:
    """Share of bodies like it, 0 to 1, that are what they look like.

    Heights are over its foot, m, `length_m` is its longer side, seen from above; `attached` the
    share of its outline beyond which its surface goes on.
    """
    share = STANDING[body.stand] * _falling(attached, ATTACHED)
    if body.cut_by_image:
        share *= CUT
    if body.stand is not Stand.ON_FLOOR:
        share *= _falling(length_m, LENGTH_M)
        if height_m > highest_m - END_M:
            share *= CUT
    return share


def _falling(value: float, limits: tuple[float, float]) -> float:
    """1 up to the first limit, 0 from the second."""
    return min(1.0, max(0.0, (limits[1] - value) / (limits[1] - limits[0])))
