"""What stands upright, of all views so far; what only an image placed can be taken back."""

from __future__ import annotations

from afkb.flow import View
from afkb_mapping.placing.held_views import HELD_LOOKS, HeldViews
from afkb_mapping.placing.scan_surface import no_surface
from afkb_mapping.placing.surface_map import SurfaceMap
from afkb_mapping.placing.view_surface import ViewSurface

NOTHING = ViewSurface(no_surface(), no_surface())
"""What is held of a view that was placed but doesn't change the map."""


class MapSoFar:
    """The surface that views are matched to: of lasers and of cameras, each by itself.

    `held`: views that may yet turn out to have been taken elsewhere.
    """

    def __init__(self) -> None:
        self._scans, self._images = SurfaceMap(), SurfaceMap()
        self.held = HeldViews()

    def of(self, seen: ViewSurface) -> SurfaceMap:
        """What a view is matched to."""
        return self._scans if seen.by_laser else self._images

    def settle(self, seen: ViewSurface) -> None:
        """Take in what a view shows, given in the map frame, for good."""
        self._add(seen)
        self.held.settled += 1

    def take_in(self, view: View, seen: ViewSurface) -> None:
        """Take in what a placed view shows, until looks that follow say otherwise."""
        self._add(seen)
        self.keep_waiting(view, seen)

    def keep_waiting(self, view: View, seen: ViewSurface = NOTHING) -> None:
        """Hold a view that was placed; a laser's is sure, and so are those before."""
        if seen.by_laser:
            self.held.release()
        else:
            self.held.hold(view, seen)

    def confirm(self) -> None:
        """Take in what those show that are held and were not taken in yet."""
        for held in self.held.release():
            self._add(held.seen)

    def take_back(self) -> int:
        """Take out what was placed just before the robot got lost; how many views that were.

        Most likely they were placed wrongly already. A map that hardly holds more than them is
        kept: in the rest nothing could be found.
        """
        if self.held.settled < HELD_LOOKS:
            self.held.release()
        taken_back = self.held.withdraw()
        for held in taken_back:
            self._scans.remove(held.seen.scan)
            self._images.remove(held.seen.image)
        return len(taken_back)

    def _add(self, seen: ViewSurface) -> None:
        self._scans.add(seen.scan)
        self._images.add(seen.image)
