"""What the mapper remembers between views of things that were seen."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from afkb.flow import ChangeKind, Detection, NodeKind, Sighting
from afkb.inference.update_rules import CERTAIN
from afkb_mapping.calibration import SCORE
from afkb_mapping.things.existence import Existence
from afkb_mapping.things.footprint import Footprint
from afkb_mapping.things.viewpoints import Viewpoints

SURFACE_CELL_M = 0.04
THING_CELL_M = 0.01
KEPT_SIGHTINGS = 5
UNSAID = 0.05
"""What a whole view from nearby is taken to say of a feature that no detector speaks of in it:
detectors leave out what they hold for next to impossible. From further away than the feature was
told from, or where the image cuts the thing, it says nothing: what can't be seen isn't absent."""


@dataclass(slots=True)
class WeightedMean:
    """Mean of measurements weighted by their inverse variance."""

    value: float = 0.0
    weight: float = 0.0

    def add(self, measured: float, variance: float) -> None:
        """Take in a measurement with its variance."""
        w = 1.0 / max(variance, 1e-12)
        self.value = (self.value * self.weight + measured * w) / (self.weight + w)
        self.weight += w

    def absorb(self, other: WeightedMean) -> None:
        """Take over another mean's measurements."""
        if other.weight:
            self.add(other.value, 1.0 / other.weight)


@dataclass(slots=True, eq=False)
class ObservedTrack:
    """One thing that was seen, over all views of it (V_ao).

    Heights (m above the floor) are means of what single views measured; `footprint` holds its
    extent; `affordance_sums` feature name to (weight, weighted probability), `told_from_m` to the
    farthest range that a view told of it from.
    """

    id: str
    is_surface: bool
    footprint: Footprint
    is_floor: bool = False
    life: Existence = field(default_factory=Existence)
    top: WeightedMean = field(default_factory=WeightedMean)
    bottom: WeightedMean = field(default_factory=WeightedMean)
    affordance_sums: dict[str, tuple[float, float]] = field(default_factory=dict)
    told_from_m: dict[str, float] = field(default_factory=dict)
    viewpoints: Viewpoints = field(default_factory=Viewpoints)
    empty_from: Viewpoints = field(default_factory=Viewpoints)
    missed_from: Viewpoints = field(default_factory=Viewpoints)
    farthest_m: float = 0.0
    observations: int = 0
    pixels: int = 0
    strength_sum: float = 0.0
    pixels_of_known_extent: int = 0
    first_seen: float = math.inf
    last_seen: float = -math.inf
    last_view: int = -1
    places: dict[str, None] = field(default_factory=dict)
    detectors: dict[str, None] = field(default_factory=dict)
    sightings: list[Sighting] = field(default_factory=list)
    predicted_first: NodeKind | None = None
    predicted_from: dict[str, None] = field(default_factory=dict)
    axioms: dict[str, None] = field(default_factory=dict)

    @property
    def existence(self) -> float:
        """Probability that it exists now."""
        return self.life.probability

    @property
    def affordances(self) -> dict[str, float]:
        """Feature name to probability: mean over the views that tell of it, by their pixels."""
        return {n: total / w for n, (w, total) in sorted(self.affordance_sums.items())}

    @property
    def conviction(self) -> float:
        """How sure its views were, all in all, that it affords anything: mean by their pixels."""
        return self.strength_sum / self.pixels

    @property
    def look_height_m(self) -> float:
        """Height of what a look at it meets first, m: its top, or its body at half height."""
        top = self.top.value
        return top if self.is_surface else (top + self.bottom.value) / 2

    @property
    def extent_known(self) -> bool:
        """Whether most of what was seen of it tells how far it reaches."""
        return 2 * self.pixels_of_known_extent >= self.pixels

    def see(
        self,
        detection: Detection,
        view_index: int,
        stamp: float,
        camera_xy: NDArray[np.float64],
    ) -> None:
        """Take in one detection of it."""
        self.footprint.add(detection.footprint_xy)
        top = detection.position_xyz[2] if self.is_surface else detection.box.top
        # A patch of a few pixels says less about the height of a table than its whole top does.
        variance = max(float(detection.covariance_xyz[2, 2]), 1e-6) / detection.n_pixels
        self.top.add(float(top), variance)
        self.bottom.add(detection.measures.get("support_height", detection.box.bottom), variance)
        strength = _strength(detection)
        self.strength_sum += strength * detection.n_pixels
        if self.viewpoints.is_new(camera_xy, detection.position_xyz[:2]):
            self._believe(min(strength, CERTAIN), stamp, view_index)
        self._hear(detection)
        self.observations += view_index != self.last_view
        self.pixels += detection.n_pixels
        self.farthest_m = max(self.farthest_m, detection.range_m)
        self.first_seen, self.last_seen = min(self.first_seen, stamp), max(self.last_seen, stamp)
        self.last_view = view_index
        self.detectors.update(dict.fromkeys(detection.detectors))
        self.pixels_of_known_extent += detection.n_pixels * detection.extent_known
        self._keep([_sighting(detection, view_index, stamp)])

    def _hear(self, detection: Detection) -> None:
        """Take in what a view says of what the thing affords, and what it doesn't say."""
        said = dict(detection.affordances)
        for name, farthest in self.told_from_m.items():
            if detection.range_m <= farthest and not detection.cut_by_image:
                said.setdefault(name, UNSAID)
        for name in detection.affordances:
            farthest = self.told_from_m.get(name, 0.0)
            self.told_from_m[name] = max(farthest, detection.range_m)
        n = float(detection.n_pixels)
        for name, p in said.items():
            weight, total = self.affordance_sums.get(name, (0.0, 0.0))
            self.affordance_sums[name] = (weight + n, total + n * p)

    def _keep(self, sightings: list[Sighting]) -> None:
        """Keep the sightings that show most of it."""
        best = sorted([*self.sightings, *sightings], key=lambda s: (-s.n_pixels, s.view))
        self.sightings = best[:KEPT_SIGHTINGS]

    def _believe(self, strength: float, stamp: float, view: int) -> None:
        """Existence after a sighting: a faint one of what is known already says nothing against."""
        told = max(strength, 0.5) if self.life.history else strength
        self.life.take(ChangeKind.SIGHTED, told, stamp, view)

    def forget_looks(self) -> None:
        """Let looks from where it was looked at before be evidence again: time has passed."""
        self.viewpoints, self.empty_from = Viewpoints(), Viewpoints()
        self.missed_from = Viewpoints()

    def absorb(self, other: ObservedTrack) -> None:
        """Take over another track that turned out to be the same thing."""
        self.footprint.absorb(other.footprint)
        self.top.absorb(other.top)
        self.bottom.absorb(other.bottom)
        if other.existence > self.existence:
            self.life = other.life
        for name, (w, total) in other.affordance_sums.items():
            mine = self.affordance_sums.get(name, (0.0, 0.0))
            self.affordance_sums[name] = (mine[0] + w, mine[1] + total)
        for name, farthest in other.told_from_m.items():
            self.told_from_m[name] = max(self.told_from_m.get(name, 0.0), farthest)
        self.viewpoints.seen_from += other.viewpoints.seen_from
        self.farthest_m = max(self.farthest_m, other.farthest_m)
        self.observations += other.observations
        self.pixels += other.pixels
        self.strength_sum += other.strength_sum
        self.first_seen = min(self.first_seen, other.first_seen)
        self.last_seen = max(self.last_seen, other.last_seen)
        self.last_view = max(self.last_view, other.last_view)
        for mine_, theirs in (
            (self.places, other.places),
            (self.detectors, other.detectors),
            (self.predicted_from, other.predicted_from),
            (self.axioms, other.axioms),
        ):
            mine_.update(theirs)
        self._keep(other.sightings)
        self.pixels_of_known_extent += other.pixels_of_known_extent
        self.predicted_first = self.predicted_first or other.predicted_first


def _strength(detection: Detection) -> float:
    """How sure a sighting is that there is something which affords something.

    Neither surer than such detections are right, nor than the detector that made it holds it for:
    strips as wide as a hand are there more often than not, and support little.
    """
    told = detection.parts or (detection,)
    return max(min(max(d.affordances.values()), d.measures.get(SCORE, 1.0)) for d in told)


def _sighting(detection: Detection, view_index: int, stamp: float) -> Sighting:
    return Sighting(
        view=view_index,
        stamp=stamp,
        detectors=detection.detectors,
        n_pixels=detection.n_pixels,
        range_m=detection.range_m,
        image_box=detection.image_box,
        affordances=dict(detection.affordances),
    )
