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


def wholeness(body: Body, height_m: float, highest_m: float) -> float:
    """Share of bodies like it, 0 to 1, that are what they look like; heights over their foot, m."""
    share = STANDING[body.stand]
    if body.cut_by_image:
        share *= CUT
    if body.stand is not Stand.ON_FLOOR and height_m > highest_m - END_M:
        share *= CUT
    return share
