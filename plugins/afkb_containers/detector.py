"""Contain-ability grounded in depth: things that are hollow, or closed bodies (paper §II.D.i)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from afkb.flow import Detection, View
from afkb_containers.describe import container_detection
from afkb_containers.judge import judge
from afkb_containers.looks import LEAST_CLAIM, look_at
from afkb_containers.settings import ContainerSettings
from afkb_containers.sight import Sights, step_for
from afkb_containers.sunk import sunk_containers
from afkb_mapping.bodies import Stand, body_of, is_body
from afkb_mapping.trapezoids import membership, ramp

ATTACHED = (0.08, 0.22)
"""Share of a thing's outline beyond which its surface goes on: below the first it stands free,
above the second it is part of something larger."""
ATTACHED_CLOSED = (0.04, 0.12)
"""The same for what shows no opening and whose foot is in sight: the arm of a chair is as round
and compact as a loaf, and goes on below the seat."""


class ContainerDetector:
    """Finds open and closed containers among the bodies and in the supports of earlier detectors.

    A body is judged whatever it stands on; basins and tubs are looked for in the supports.
    """

    name = "containers"
    affordances = ("ContainAbility", "IntrinsicContainAbility")
    stage = 2

    def __init__(self, settings: ContainerSettings | None = None) -> None:
        self.settings = settings or ContainerSettings()

    def detect(self, view: View, earlier: Sequence[Detection]) -> list[Detection]:
        """Containers in the map frame; none where the view has no depth."""
        if view.depth_m is None or view.camera is None:
            return []
        sights = Sights(view)
        judged = (
            self._detection(index, thing, view, sights)
            for index, thing in enumerate(earlier)
            if is_body(thing)
        )
        found = [d for d in judged if d is not None]
        return found + list(sunk_containers(view, earlier, self.settings, self.name))

    def _detection(
        self, index: int, thing: Detection, view: View, sights: Sights
    ) -> Detection | None:
        s, m = self.settings, thing.measures
        sides, attached, stand = (m["length"], m["width"]), m["attached"], Stand(int(m["stand"]))
        size = membership(sides[0], s.sides_m(stand)) * (1 - ramp(attached, ATTACHED))
        low = stand is Stand.ON_FLOOR or m["height"] <= s.tallest_m - 0.02
        if size <= 0 or not low:
            return None
        step, cut = step_for(thing.n_pixels), thing.cut_by_image or sights.cuts(thing)
        body = body_of(thing, view, step)
        looks = look_at(body, sides, cut, sights.every(step), s)
        part = ramp(attached, ATTACHED_CLOSED) if stand is Stand.ON_SUPPORT else 0.0
        verdict = judge(body, size, 1 - part, cut, looks, s)
        if verdict.contains < LEAST_CLAIM:
            return None
        told = container_detection(body, thing, index, verdict, looks, self.name)
        return replace(told, cut_by_image=cut)
