"""Things: every body that stands on a support, on a hidden one, or on the floor."""

from __future__ import annotations

from collections.abc import Sequence

from afkb.flow import Detection, View
from afkb_mapping.bodies import Body
from afkb_things.clusters import clusters_from_above
from afkb_things.describe import body_detection
from afkb_things.furniture import is_part
from afkb_things.hidden import loose_of, things_on_hidden_supports, things_on_the_floor
from afkb_things.rejoin import rejoined
from afkb_things.scene import Scene
from afkb_things.settings import ThingSettings
from afkb_things.split import split
from afkb_things.surroundings import mark, named, surroundings
from afkb_things.wholeness import ATTACHED

UNSURE = 2
"""Where no support is in sight, parts of furniture abound: so many times more pixels make a body
of a part."""


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
        standing = rejoined(self._on_supports(scene), scene)
        loose = loose_of(scene)
        found = [self._free(standing, scene)]
        for apart in (things_on_hidden_supports, things_on_the_floor):
            whole = [
                body
                for one in apart(scene, loose, s.min_pixels)
                for body, _ in self._free([one], scene)
            ]
            found += [
                self._free([part], scene) for part in split(whole, scene, UNSURE * s.min_pixels)
            ]
        return [
            body_detection(body, attached, self.name)
            for free in found
            for body, attached in free
            if not is_part(body, scene.supports)
        ]

    def _free(self, bodies: Sequence[Body], scene: Scene) -> list[tuple[Body, float]]:
        """The bodies that aren't part of something larger, and how far each one's surface goes on.

        Where it goes on into a neighbour that is such a part, it goes on, too.
        """
        kept = dict(enumerate(bodies, start=1))
        labels = (scene.labels, scene.overs_m, self.settings.core_m, scene.noise)
        with named(bodies, scene.names) as names:
            for _ in range(2):
                attached = {
                    k: surroundings(b.u, b.v, scene.depth_m, names, k, *labels)[0]
                    for k, b in kept.items()
                }
                parts = [k for k in kept if attached[k] >= ATTACHED[1]]
                for k in parts:
                    mark(kept[k].u, kept[k].v, names, 0)
                    del kept[k]
                if not parts:
                    break
        return [(body, attached[k]) for k, body in kept.items()]

    def _on_supports(self, scene: Scene) -> list[Body]:
        groups: list[Body] = []
        for support, u, v in scene.on_each_support(self.settings.min_pixels):
            groups += clusters_from_above(u, v, scene, support, self.settings)
        return split(groups, scene, self.settings.min_pixels)
