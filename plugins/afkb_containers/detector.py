"""Contain-ability grounded in depth: things that are hollow, or closed bodies (paper §II.D.i)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from afkb.flow import Detection, View
from afkb_containers.judge import LEAST_CLAIM, container_detection, judge
from afkb_containers.settings import ContainerSettings
from afkb_containers.solid import solid_of
from afkb_containers.sunk import sunk_containers
from afkb_mapping.bodies import Body, Stand, bodies_among
from afkb_mapping.openings import find_opening
from afkb_mapping.trapezoids import membership

ATTACHED = (0.08, 0.22)
"""Share of a thing's outline beyond which its surface goes on: below the first it stands free,
above the second it is part of something larger."""


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
        camera_xyz = view.T_map_camera[:3, 3]
        judged = (
            self._detection(k, body, earlier[k], camera_xyz)
            for k, body in bodies_among(earlier, view)
        )
        found = [d for d in judged if d is not None]
        return found + list(sunk_containers(view, earlier, self.settings, self.name))

    def _detection(
        self, index: int, body: Body, thing: Detection, camera_xyz: NDArray[np.float64]
    ) -> Detection | None:
        s = self.settings
        length, attached = thing.measures["length"], thing.measures["attached"]
        size = membership(length, s.sides_m(body.stand))
        size *= min(1.0, max(0.0, (ATTACHED[1] - attached) / (ATTACHED[1] - ATTACHED[0])))
        if size <= 0:
            return None
        solid = solid_of(body, length, s)
        if body.stand is not Stand.ON_FLOOR and solid.height_m > s.tallest_m - 0.02:
            return None
        opening = find_opening(body, camera_xyz)
        verdict = judge(body, size, solid, opening, s)
        if verdict.contains < LEAST_CLAIM:
            return None
        return container_detection(body, index, verdict, solid, opening, self.name)
