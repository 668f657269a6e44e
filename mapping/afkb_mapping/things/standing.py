"""What a thing stands on, or is let into: by outline and height."""

from __future__ import annotations

from collections.abc import Iterable

from afkb_mapping.things.tracks import ObservedTrack

STANDS_WITHIN_M = 0.06
"""A thing's foot and the surface it stands on agree within this: noise of both."""
FOOT_HIDDEN_M = 0.20
"""What stands before a thing hides so much of its foot at most."""
ON_SHARE = 0.3
"""A thing stands on a surface if this part of its outline lies over it; the rest of the surface
under it is hidden by the thing itself."""


def support_of(track: ObservedTrack, surfaces: Iterable[ObservedTrack]) -> ObservedTrack | None:
    """The surface that carries a thing: the one right below it, or the one it is let into.

    A basin hangs in its counter by the rim. What reaches down to the floor stands on it, by height
    alone, since it hides the floor below.
    """
    if track.is_surface:
        return None
    points = track.footprint.points()
    best: tuple[float, ObservedTrack] | None = None
    for surface in surfaces:
        if surface.is_floor:
            continue
        gap = _gap(track, surface)
        if gap is None or (best is not None and gap >= best[0]):
            continue
        if surface.footprint.share_within(points, 2 * surface.footprint.cell_m) > ON_SHARE:
            best = gap, surface
    if best is None and track.bottom.value <= STANDS_WITHIN_M:
        return next((s for s in surfaces if s.is_floor), None)
    return best[1] if best else None


def _gap(track: ObservedTrack, surface: ObservedTrack) -> float | None:
    """How far a thing's foot, or else its rim, is from a surface, m; None if too far."""
    foot = track.bottom.value - surface.top.value
    if -STANDS_WITHIN_M <= foot <= FOOT_HIDDEN_M:
        return abs(foot)
    rim = abs(track.top.value - surface.top.value)
    return FOOT_HIDDEN_M + rim if rim <= STANDS_WITHIN_M and foot < 0 else None
