"""Things: every body that stands on a support, on a hidden one, or on the floor."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import chain

import numpy as np

from afkb.flow import Detection, View
from afkb_mapping.bodies import Body
from afkb_mapping.image_regions import pixels_by_label
from afkb_things.clusters import clusters_from_above
from afkb_things.describe import body_detection
from afkb_things.hidden import Loose, things_on_hidden_supports, things_on_the_floor
from afkb_things.scene import Scene
from afkb_things.settings import ThingSettings
from afkb_things.surroundings import surroundings


class ThingDetector:
    """Cuts out what stands on a support; uses the supports that an earlier detector found.

    It judges no shape: later detectors do that, by each body's pixels. What it says a body affords
    is what any free-standing one of its kind does, dispose-ability: to be set down on a support.
    """

    name = "things"
    affordances = ("DisposeAbility",)
    stage = 1

    def __init__(self, settings: ThingSettings | None = None) -> None:
        self.settings = settings or ThingSettings()

    def detect(self, view: View, earlier: Sequence[Detection]) -> list[Detection]:
        """One detection a body, in the map frame; none where the view has no depth."""
        s = self.settings
        scene = Scene.of(view, earlier, s)
        if scene is None:
            return []
        loose = Loose.of(scene)
        bodies = chain(
            self._on_supports(scene),
            things_on_hidden_supports(scene, loose, s.min_pixels),
            things_on_the_floor(scene, loose, s.min_pixels),
        )
        mine, found = np.zeros(scene.depth_m.shape, np.int32), []
        for name, body in enumerate(bodies, start=1):
            attached, *_ = surroundings(
                body.u, body.v, scene.depth_m, mine, name, scene.labels, scene.overs_m, s.core_m
            )
            detection = body_detection(body, attached, self.name)
            if detection is not None:
                found.append(detection)
        return found

    def _on_supports(self, scene: Scene) -> Iterator[Body]:
        n = len(scene.supports.heights_m) + 1
        u, v, starts = pixels_by_label(scene.labels, np.ones(n, np.bool_), np.ones(n, np.int64))
        for k in np.flatnonzero(np.diff(starts) >= self.settings.min_pixels):
            part = slice(int(starts[k]), int(starts[k + 1]))
            yield from clusters_from_above(u[part], v[part], scene, int(k) - 1, self.settings)
