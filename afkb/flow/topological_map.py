"""The map: G(V, E) embedded in an occupancy grid O (paper §II.E), as plain data."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from afkb.flow.evidence import Change, Sighting
from afkb.flow.loops import LoopProposal
from afkb.flow.prediction import PastPrediction, PredictionState, Region


class NodeKind(StrEnum):
    """The four vertex sets of the paper: V_r, V_ao, V_ap, V_ac; values are the OWL classes."""

    ROBOT_PLACE = "RobotPlace"
    OBSERVED = "ObservedEntity"
    DUAL = "DualPrediction"
    CO_OCCURRENCE = "CoOccurrencePrediction"


class EdgeKind(StrEnum):
    """What an edge measures: way between places, distance to an obstacle (E_d) or bound (E_l)."""

    PATH = "path"
    OBSTACLE = "obstacle"
    BOUND = "bound"


@dataclass(frozen=True, slots=True)
class RobotPlace:
    """A place of the robot (V_r): base pose on the floor plane, map frame, m and rad."""

    id: str
    x: float
    y: float
    yaw: float
    stamp: float
    view_index: int
    room: str | None = None


@dataclass(frozen=True, slots=True, eq=False)
class Entity:
    """A thing, observed (V_ao) or predicted (V_ap, V_ac); map frame, m and rad.

    - `position_xyz`, `size_xyz`, `yaw`: as DESIGN's vocabulary states: centre of the upper surface
      for supports, centre of the box else; oriented box.
    - `polygon_xy`: (N, 2) outline seen from above, or None.
    - `existence`: probability that it exists now. `matching_weight`: its weight when maps are
      matched and the grid is filled (about 0.3 for dynamic things, §II.D.i).
    - `movability`: `Static` or `Dynamic`.
    - `observations`: distinct views that saw it (observed) or implied it (predicted).
    - `first_seen`, `last_seen`: s. `seen_from`: ids of robot places.
    - `supported_by`, `part_of`, `room`: ids or None. `predicted_from`: ids of entities.
    - `predicted_first`: kind under which it was predicted before it was seen, else None.
    - `generated_by`: detectors or predictors; `axioms`: IRIs behind it.
    - `sightings`: the views that showed most of it; `history`: the last steps of its existence,
      oldest first, which lead to it.
    - `region`: of a predicted one, where it may be; `state`: how the prediction stands.
    """

    id: str
    kind: NodeKind
    position_xyz: tuple[float, float, float]
    size_xyz: tuple[float, float, float]
    yaw: float
    affordances: Mapping[str, float]
    existence: float
    category_belief: Mapping[str, float]
    movability: str
    matching_weight: float
    observations: int
    first_seen: float
    last_seen: float
    seen_from: tuple[str, ...]
    generated_by: tuple[str, ...]
    supported_by: str | None = None
    part_of: str | None = None
    room: str | None = None
    predicted_from: tuple[str, ...] = ()
    predicted_first: NodeKind | None = None
    axioms: tuple[str, ...] = ()
    extent_known: bool = True
    polygon_xy: NDArray[np.float64] | None = None
    sightings: tuple[Sighting, ...] = ()
    history: tuple[Change, ...] = ()
    region: Region | None = None
    state: PredictionState | None = None

    def affords(self, feature: str, at_least: float = 0.5) -> bool:
        """Whether it affords the feature with at least that probability."""
        return self.affordances.get(feature, 0.0) >= at_least

    @property
    def top_m(self) -> float:
        """Height of its upper side above the floor, m: of what supports, of its upper surface."""
        z, height = self.position_xyz[2], self.size_xyz[2]
        return z if self.affords("SupportAbility") else z + height / 2


@dataclass(frozen=True, slots=True)
class Bound:
    """A straight piece of wall on the floor plane: end points, m; fitted from laser or depth.

    - `sigmas`: standard deviations of its line's offset (m) and direction (rad), or None.
    - `existence`: probability that it still stands; `first_seen`, `last_seen`: s, the map's clock.
    """

    id: str
    start_xy: tuple[float, float]
    end_xy: tuple[float, float]
    observations: int
    generated_by: tuple[str, ...]
    room: str | None = None
    sigmas: tuple[float, float] | None = None
    existence: float = 1.0
    first_seen: float = 0.0
    last_seen: float = 0.0


@dataclass(frozen=True, slots=True)
class Doorway:
    """A passage between two rooms: middle of the opening (m), direction across it (rad).

    `existence`: probability that it is open now.
    """

    id: str
    x: float
    y: float
    yaw: float
    width: float
    rooms: tuple[str, ...]
    existence: float = 1.0


@dataclass(frozen=True, slots=True, eq=False)
class Room:
    """A room: a point inside, area (m²), outline (N, 2), and a posterior over its purpose.

    `belief` sums to 1 and has `UnknownRoom` among its keys. `visited`: the robot stood in it.
    `connected_to`: ids of rooms that one gets to from it directly, through a doorway or over the
    open border of two parts of an open plan. `evidence`: evidence class to how many things of it
    were counted; what is 0 was looked for. `other_beliefs`: what room classifiers make of it, by
    their name, each a posterior like `belief`. `second_purpose`: of an open plan that serves two
    purposes and can't be divided, the category of its other purpose and how likely it has one.
    """

    id: str
    x: float
    y: float
    area: float
    polygon_xy: NDArray[np.float64]
    belief: Mapping[str, float]
    visited: bool = True
    connected_to: tuple[str, ...] = ()
    evidence: Mapping[str, int] = field(default_factory=dict)
    other_beliefs: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    second_purpose: tuple[str, float] | None = None


@dataclass(frozen=True, slots=True)
class Edge:
    """An edge with its distance (m) and bearing (rad, map frame) from `source` to `target`.

    `linkage_angle` (paper: E_t(θ_ij)): between places the difference of the robot's headings,
    else between its heading and the bearing of the thing or bound, rad.
    """

    id: str
    kind: EdgeKind
    source: str
    target: str
    distance: float
    bearing: float
    linkage_angle: float | None = None


@dataclass(frozen=True, slots=True)
class Closure:
    """A predicted node that was then seen: the paper's loop-closing event.

    `displacement_m`: from where it was predicted to where it is; `place`: from where it was seen;
    `predicted_stamp`: when it was predicted first, s.
    """

    entity: str
    predicted_as: NodeKind
    predicted_probability: float
    displacement_m: float
    place: str
    stamp: float
    predicted_stamp: float = math.nan


@dataclass(frozen=True, slots=True, eq=False)
class OccupancyGrid:
    """Occupancy probabilities in the map frame.

    `probability`: (rows, cols) float32 in 0..1, NaN where nothing is known; cell (0, 0) has its
    lower left corner at `origin_xy` (m); rows run along +y, columns along +x; a cell is
    `resolution_m` wide.
    """

    probability: NDArray[np.float32]
    resolution_m: float
    origin_xy: tuple[float, float]


@dataclass(frozen=True, slots=True, eq=False)
class TopologicalMap:
    """The whole map, as it is stored, exported and asked.

    - `T_map_source` (4, 4): from the source's pose frame to the map frame at the first view.
    - `trajectory` (N, 17): stamp (s), then T_map_base (4x4) row by row, one row a view.
    - `closures`: predictions that came true; `past_predictions`: all that came to an end.
    - `loops`: places that were, or may have been, seen again, rejected ones with their reason.
    - `notes`: what had to be assumed; `counts`: of the run's bookkeeping (births, merges, refuted
      predictions).
    """

    places: tuple[RobotPlace, ...]
    entities: tuple[Entity, ...]
    bounds: tuple[Bound, ...]
    doorways: tuple[Doorway, ...]
    rooms: tuple[Room, ...]
    edges: tuple[Edge, ...]
    grid: OccupancyGrid
    T_map_source: NDArray[np.float64]
    trajectory: NDArray[np.float64]
    closures: tuple[Closure, ...] = ()
    past_predictions: tuple[PastPrediction, ...] = ()
    loops: tuple[LoopProposal, ...] = ()
    notes: tuple[str, ...] = ()
    counts: Mapping[str, int] = field(default_factory=dict)
