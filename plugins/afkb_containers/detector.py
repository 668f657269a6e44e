"""Contain-ability grounded in depth: things that are hollow, or closed bodies (paper §II.D.i)."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import chain

import numpy as np
from numpy.typing import NDArray

from afkb.flow import Detection, View
from afkb_containers.clusters import Cluster, clusters_from_above
from afkb_containers.concavity import find_opening
from afkb_containers.hidden import Loose, things_on_hidden_supports, things_on_the_floor
from afkb_containers.judge import LEAST_CLAIM, container_detection, judge
from afkb_containers.scene import Scene
from afkb_containers.settings import ContainerSettings
from afkb_containers.solid import sides_from_above, solid_of
from afkb_containers.stand import Stand
from afkb_containers.sunk import sunk_containers
from afkb_containers.surroundings import surroundings
from afkb_mapping.image_regions import pixels_by_label
from afkb_mapping.trapezoids import membership

ATTACHED = (0.08, 0.22)
"""Share of a thing's outline beyond which its surface goes on: below the first it stands free,
above the second it is part of something larger."""


class ContainerDetector:
    """Finds open and closed containers; uses the supports that an earlier detector found.

    Looks at what stands on a support, on a support that is hidden, on the floor, and at what is
    let into a support (basins and tubs).
    """

    name = "containers"
    affordances = ("ContainAbility", "IntrinsicContainAbility")
    stage = 1

    def __init__(self, settings: ContainerSettings | None = None) -> None:
        self.settings = settings or ContainerSettings()

    def detect(self, view: View, earlier: Sequence[Detection]) -> list[Detection]:
        """Containers in the map frame; none where the view has no depth."""
        s = self.settings
        scene = Scene.of(view, earlier, s)
        if scene is None:
            return []
        loose = Loose.of(scene)
        things = chain(
            self._on_supports(scene),
            things_on_hidden_supports(scene, loose, s.min_pixels),
            things_on_the_floor(scene, loose, s.min_pixels),
        )
        mine = np.zeros(scene.depth_m.shape, np.int32)
        judged = (self._detection(c, scene, mine, name) for name, c in enumerate(things, start=1))
        found = [d for d in judged if d is not None]
        return found + list(sunk_containers(scene, s, self.name))

    def _on_supports(self, scene: Scene) -> Iterator[Cluster]:
        n = len(scene.supports.heights_m) + 1
        u, v, starts = pixels_by_label(scene.labels, np.ones(n, np.bool_), np.ones(n, np.int64))
        for k in np.flatnonzero(np.diff(starts) >= self.settings.min_pixels):
            part = slice(int(starts[k]), int(starts[k + 1]))
            height = float(scene.supports.heights_m[k - 1])
            yield from clusters_from_above(u[part], v[part], scene, height, self.settings)

    def _detection(
        self, cluster: Cluster, scene: Scene, mine: NDArray[np.int32], name: int
    ) -> Detection | None:
        s = self.settings
        length, _ = sides_from_above(cluster.points)
        size = membership(length, s.sides_m(cluster.stand))
        if size <= 0:
            return None
        attached, *_ = surroundings(
            cluster.u, cluster.v, scene.depth_m, mine, name, scene.labels, scene.overs_m, s.core_m
        )
        size *= min(1.0, max(0.0, (ATTACHED[1] - attached) / (ATTACHED[1] - ATTACHED[0])))
        if size <= 0:
            return None
        base = cluster.lowest_m if cluster.support_height_m is None else cluster.support_height_m
        solid = solid_of(cluster, base, length, s)
        if cluster.stand is not Stand.ON_FLOOR and solid.height_m > s.above_m[1] - 0.02:
            return None
        opening = find_opening(cluster, scene.camera_xyz)
        verdict = judge(cluster, size, solid, opening, s)
        if verdict.contains < LEAST_CLAIM:
            return None
        return container_detection(cluster, base, verdict, solid, opening, self.name)
