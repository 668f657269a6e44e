"""What the mapper remembers of things between views: observed ones and predicted ones."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from afkb.flow import Detection, NodeKind
from afkb_mapping.footprint import Footprint
from afkb_mapping.update_rules import CERTAIN, log_odds

SURFACE_CELL_M = 0.04
THING_CELL_M = 0.01
DISTINCT_STEP_M = 0.25
DISTINCT_BEARING = math.radians(10)
"""Looks from closer together than both of these are one piece of evidence, not two."""
KEPT_EVIDENCE = 5
UNSAID = 0.05
"""What a view is taken to say of a feature that no detector speaks of in it: detectors leave out
what they hold for next to impossible."""


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
class Viewpoints:
    """From where a thing was looked at; tells new viewpoints from repeated ones."""

    seen_from: list[tuple[float, float]] = field(default_factory=list)

    def is_new(self, camera_xy: NDArray[np.float64], thing_xy: NDArray[np.float64]) -> bool:
        """Whether a look from here is independent of the earlier ones; remembers it if so."""
        for other in self.seen_from:
            step = float(np.hypot(*(camera_xy - other)))
            if step < DISTINCT_STEP_M and _angle_between(camera_xy, other, thing_xy) < (
                DISTINCT_BEARING
            ):
                return False
        self.seen_from.append((float(camera_xy[0]), float(camera_xy[1])))
        return True


def _angle_between(
    a: NDArray[np.float64], b: tuple[float, float], apex: NDArray[np.float64]
) -> float:
    to_a, to_b = a - apex, np.asarray(b) - apex
    cross = to_a[0] * to_b[1] - to_a[1] * to_b[0]
    return abs(math.atan2(float(cross), float(to_a @ to_b)))


@dataclass(slots=True, eq=False)
class ObservedTrack:
    """One thing that was seen, over all views of it (V_ao).

    Heights (m above the floor) are means of what single views measured; `footprint` holds its
    extent; `affordance_sums` feature name to (weight, weighted probability).
    """

    id: str
    is_surface: bool
    footprint: Footprint
    is_floor: bool = False
    existence: float = 0.5
    top: WeightedMean = field(default_factory=WeightedMean)
    bottom: WeightedMean = field(default_factory=WeightedMean)
    affordance_sums: dict[str, tuple[float, float]] = field(default_factory=dict)
    viewpoints: Viewpoints = field(default_factory=Viewpoints)
    empty_from: Viewpoints = field(default_factory=Viewpoints)
    missed_from: Viewpoints = field(default_factory=Viewpoints)
    farthest_m: float = 0.0
    observations: int = 0
    pixels: int = 0
    pixels_of_known_extent: int = 0
    first_seen: float = math.inf
    last_seen: float = -math.inf
    last_view: int = -1
    places: dict[str, None] = field(default_factory=dict)
    detectors: dict[str, None] = field(default_factory=dict)
    evidence: list[str] = field(default_factory=list)
    predicted_first: NodeKind | None = None
    predicted_from: dict[str, None] = field(default_factory=dict)
    axioms: dict[str, None] = field(default_factory=dict)

    @property
    def affordances(self) -> dict[str, float]:
        """Feature name to probability: mean over all views of it, by their pixels.

        A view that shows it and doesn't speak of a feature speaks against it.
        """
        return {
            name: (total + UNSAID * (self.pixels - weight)) / self.pixels
            for name, (weight, total) in sorted(self.affordance_sums.items())
        }

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
        strength = max(detection.affordances.values())
        if self.viewpoints.is_new(camera_xy, detection.position_xyz[:2]):
            self._believe(min(strength, CERTAIN))
        for name, p in detection.affordances.items():
            weight, total = self.affordance_sums.get(name, (0.0, 0.0))
            n = float(detection.n_pixels)
            self.affordance_sums[name] = (weight + n, total + n * p)
        self.observations += view_index != self.last_view
        self.pixels += detection.n_pixels
        self.farthest_m = max(self.farthest_m, detection.range_m)
        self.first_seen, self.last_seen = min(self.first_seen, stamp), max(self.last_seen, stamp)
        self.last_view = view_index
        self.detectors.update(dict.fromkeys(detection.detectors))
        self.pixels_of_known_extent += detection.n_pixels * detection.extent_known
        if len(self.evidence) < KEPT_EVIDENCE:
            self.evidence.append(_evidence(detection, view_index))

    def _believe(self, strength: float) -> None:
        """Existence after a sighting: a faint one of what is known already says nothing against."""
        first = len(self.viewpoints.seen_from) == 1
        self.existence = strength if first else log_odds(self.existence, max(strength, 0.5))

    def absorb(self, other: ObservedTrack) -> None:
        """Take over another track that turned out to be the same thing."""
        self.footprint.absorb(other.footprint)
        self.top.absorb(other.top)
        self.bottom.absorb(other.bottom)
        self.existence = max(self.existence, other.existence)
        for name, (w, total) in other.affordance_sums.items():
            mine = self.affordance_sums.get(name, (0.0, 0.0))
            self.affordance_sums[name] = (mine[0] + w, mine[1] + total)
        self.viewpoints.seen_from += other.viewpoints.seen_from
        self.farthest_m = max(self.farthest_m, other.farthest_m)
        self.observations += other.observations
        self.pixels += other.pixels
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
        self.evidence = (self.evidence + other.evidence)[:KEPT_EVIDENCE]
        self.pixels_of_known_extent += other.pixels_of_known_extent
        self.predicted_first = self.predicted_first or other.predicted_first


def _evidence(detection: Detection, view_index: int) -> str:
    where = ""
    if detection.image_box is not None:
        u0, v0, u1, v1 = detection.image_box
        where = f", image {u0},{v0} to {u1},{v1}"
    return f"{' and '.join(detection.detectors)}: view {view_index}{where}, {detection.n_pixels} px"


@dataclass(slots=True, eq=False)
class PredictedTrack:
    """One thing that is expected (V_ap or V_ac), where, how high, and how likely it is.

    It covers an upright rectangle `low_xy`..`high_xy` of the floor plane; `top_range_m` are the
    heights its top may have, m. `near_xy`: what it is expected near to, None for what is below.
    """

    id: str
    kind: NodeKind
    low_xy: NDArray[np.float64]
    high_xy: NDArray[np.float64]
    top_range_m: tuple[float, float]
    probability: float
    affordances: dict[str, float]
    scale: str
    anchors: dict[str, None]
    predictor: str
    axioms: dict[str, None]
    first_seen: float
    last_seen: float
    categories: dict[str, float] = field(default_factory=dict)
    observations: int = 1
    viewpoints: Viewpoints = field(default_factory=Viewpoints)
    empty_from: Viewpoints = field(default_factory=Viewpoints)
    places: dict[str, None] = field(default_factory=dict)
    reach_m: float = 0.0
    near_xy: NDArray[np.float64] | None = None

    @property
    def center_xy(self) -> NDArray[np.float64]:
        """Middle of the rectangle, m."""
        return (self.low_xy + self.high_xy) / 2

    @property
    def size_xy(self) -> NDArray[np.float64]:
        """Extent of the rectangle, m."""
        return self.high_xy - self.low_xy

    def sample_points(self, step_m: float = 0.1) -> NDArray[np.float64]:
        """(N, 3) points on its expected upper surface, map frame."""
        axes = [
            np.linspace(lo, hi, max(2, round((hi - lo) / step_m)))
            for lo, hi in zip(self.low_xy, self.high_xy, strict=True)
        ]
        x, y = np.meshgrid(*axes)
        z = np.full(x.size, self.top_range_m[1])
        return np.column_stack([x.ravel(), y.ravel(), z])
