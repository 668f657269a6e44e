"""What a detector says about one view."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

WHOLE_FROM = 0.8
"""A thing is seen whole if this share of its outline is its own: something hides a little of
nearly everything."""


@dataclass(frozen=True, slots=True)
class OrientedBox:
    """Upright box in the map frame: centre (m), full size along its own axes (m), yaw (rad)."""

    center_xyz: tuple[float, float, float]
    size_xyz: tuple[float, float, float]
    yaw: float = 0.0

    @property
    def bottom(self) -> float:
        """Height of its underside above the floor, m."""
        return self.center_xyz[2] - self.size_xyz[2] / 2

    @property
    def top(self) -> float:
        """Height of its upper side above the floor, m."""
        return self.center_xyz[2] + self.size_xyz[2] / 2


@dataclass(frozen=True, slots=True, eq=False)
class Primitive:
    """The simple shape that fits a body best, upright or not, in the map frame.

    - `kind`: `box`, `cylinder`, `sphere`, `cone` or `superquadric`.
    - `T_map_body`: 4x4, the body's own axes; a cylinder's or cone's axis is its z, whose positive
      end is the narrow one of a cone.
    - `size_xyz`: full size along these axes, m. `exponents`: (e1, e2) of the superquadric that it
      is (Jaklic et al. 2000): box near 0, cylinder (0, 1), sphere (1, 1).
    - `residual_m`: rms distance of the visible points from it.
    """

    kind: str
    T_map_body: NDArray[np.float64]
    size_xyz: tuple[float, float, float]
    exponents: tuple[float, float]
    residual_m: float


@dataclass(frozen=True, slots=True, eq=False)
class Detection:
    """One affordance-bearing thing, surface or bound seen in one view, in the map frame.

    - `affordances`: feature name (`SupportAbility`, …) to the probability that it affords it.
    - `position_xyz`: of whatever affords support the centre of its upper surface, at its top;
      of anything else the centre of its box (m).
    - `covariance_xyz`: (3, 3) m², of `position_xyz`.
    - `footprint_xy`: (N, 2) float64, m: points of the upper surface (or of the thing, seen from
      above), about 0.02 m apart; what partial views merge by.
    - `segment_xy`: (2, 2) m, end points of a bound (wall) on the floor plane; else None.
    - `n_pixels`, `image_box` (u0, v0, u1, v1, half-open): the evidence in the image; a laser
      bound counts beams and has no image box.
    - `cut_by_image`: the image edge cuts it, so its extent is a lower bound.
    - `extent_known`: False where the sensor returns too little to tell how far it reaches
      (glossy or black tops); position is then that of the part that was seen.
    - `range_m`: distance from the sensor to the nearest part, m.
    - `about`: index, among the view's earlier detections, of one of the same thing: this one adds
      to what that affords, and shares its place. None for what is told of for the first time.
    - `pixels`: (n,) int32 flat indexes (v * width + u) into the depth image of what shows it; None
      where none are kept.
    - `rings_xy`: outline seen from above, m: the outer ring (N, 2), then its holes; may be empty.
    - `border`: shares of the outline that are `real`, `occluded` by something nearer, `cut` by the
      image edge, or `missing` (the sensor returns nothing beyond); they sum to 1, or it is empty.
    - `primitive`: the simple shape of a body, or None.
    - `parts`: the detections that this one joins, in the order they were made; empty for one that
      a detector made.
    """

    detector: str
    affordances: Mapping[str, float]
    box: OrientedBox
    position_xyz: NDArray[np.float64]
    covariance_xyz: NDArray[np.float64]
    footprint_xy: NDArray[np.float64]
    n_pixels: int
    range_m: float
    image_box: tuple[int, int, int, int] | None = None
    segment_xy: NDArray[np.float64] | None = None
    cut_by_image: bool = False
    extent_known: bool = True
    measures: Mapping[str, float] = field(default_factory=dict)
    about: int | None = None
    pixels: NDArray[np.int32] | None = None
    rings_xy: tuple[NDArray[np.float64], ...] = ()
    border: Mapping[str, float] = field(default_factory=dict)
    primitive: Primitive | None = None
    parts: tuple[Detection, ...] = ()

    def __post_init__(self) -> None:
        if not self.affordances:
            raise ValueError(f"{self.detector}: a detection affords something")
        for name, p in self.affordances.items():
            if not (math.isfinite(p) and 0 <= p <= 1):
                raise ValueError(f"{self.detector}: {name} has probability {p}, not in 0..1")
        at = self.position_xyz
        if at.shape != (3,) or not all(map(math.isfinite, at.tolist())):
            raise ValueError(f"{self.detector}: position {self.position_xyz} is not a finite (3,)")

    @property
    def detectors(self) -> tuple[str, ...]:
        """Names of all detectors that spoke of it, the first to do so first."""
        return tuple(dict.fromkeys(d.detector for d in self.parts)) or (self.detector,)

    @property
    def seen_whole(self) -> bool:
        """Whether this view tells how far it reaches: little of its outline is cut or hidden."""
        if not self.border:
            return self.extent_known and not self.cut_by_image
        return self.border.get("real", 0.0) >= WHOLE_FROM

    def affords(self, feature: str, at_least: float = 0.5) -> bool:
        """Whether it affords the feature with at least that probability."""
        return self.affordances.get(feature, 0.0) >= at_least
