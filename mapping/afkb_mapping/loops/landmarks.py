"""Static things as single views saw them: what places are recognised by (paper §II.D.i)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from afkb.errors import EvidenceError
from afkb.flow import Detection, View
from afkb.inference import Network
from afkb.knowledge import SOMETHING_ELSE
from afkb_mapping.geometry import inverse, transform_xy
from afkb_mapping.structure import is_structure

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

FAINT_WEIGHT = 0.1
"""What matches with less weight than this moves about too much to tell a place by."""
WHOLE_SIGMA_M = 0.04
"""Centres of things that were seen whole differ by this between views, beside sensor noise."""
PART_SHARE = 0.3
"""Of what was seen in part the centre may be off by this share of its length."""
SAME_TOP_M = 0.05
"""Tops of one thing agree in height within this between views: levelling and noise together."""
LEAST_REACH_M = 0.05
"""Sights of one thing lie within half its width of each other, or this."""


@dataclass(frozen=True, slots=True, eq=False)
class Landmarks:
    """N things in one frame, as arrays.

    - `xy`: (N, 2) m, centres; `sigma_m`: (N,) standard deviations of these.
    - `top_m`: (N,) height of the upper side above the floor; `is_surface`: (N,) it supports.
    - `size_m`: (N, 2) length and width, m; lower bounds unless seen `whole` (N,).
    - `affords`: (N, F) probabilities of the ontology's features. `root_belief`: (N, C) square roots
      of the posterior of what it is: the product of two is their Bhattacharyya coefficient.
    - `weight`: (N,) 0..1, when maps are matched; about 0.3 for what moves (§II.D.i).
    """

    xy: Array
    sigma_m: Array
    top_m: Array
    is_surface: Flags
    size_m: Array
    whole: Flags
    affords: Array
    root_belief: Array
    weight: Array

    def __len__(self) -> int:
        return len(self.xy)

    def __getitem__(self, which: NDArray[np.intp] | Flags) -> Landmarks:
        """Some of them."""
        return Landmarks(*(getattr(self, name)[which] for name in self.__slots__))

    def seen_from(self, T: Array) -> Landmarks:
        """The same in the frame in which their base stands at T (4, 4)."""
        return replace(self, xy=transform_xy(T, self.xy))

    def distinct(self) -> NDArray[np.intp]:
        """Indexes of the surest sight of each thing, the surest first."""
        order = np.lexsort((self.top_m, -self.weight, self.sigma_m))
        first, second = self._pairs_of_one()
        starts = np.searchsorted(first, np.arange(len(self) + 1))
        left = np.ones(len(self), bool)
        kept = []
        for k in order.tolist():
            if left[k]:
                kept.append(k)
                left[second[starts[k] : starts[k + 1]]] = False
        return np.array(kept, np.intp)

    def _pairs_of_one(self) -> NDArray[np.intp]:
        """(2, P) pairs that may be sights of one thing, each in both orders, by the first."""
        if not len(self):
            return np.empty((2, 0), np.intp)
        reach = np.maximum(np.maximum(self.size_m[:, 1] / 2, self.sigma_m), LEAST_REACH_M)
        farthest = float(reach.max()) * (1 + 1e-9)
        a, b = cKDTree(self.xy).query_pairs(farthest, output_type="ndarray").T
        narrower = np.minimum(self.size_m[a, 1], self.size_m[b, 1]) / 2
        within = np.maximum(narrower, np.minimum(self.sigma_m[a], self.sigma_m[b]))
        same = np.hypot(*(self.xy[a] - self.xy[b]).T) <= np.maximum(within, LEAST_REACH_M)
        same &= np.abs(self.top_m[a] - self.top_m[b]) <= SAME_TOP_M
        same &= self.is_surface[a] == self.is_surface[b]
        both = np.concatenate([[a[same], b[same]], [b[same], a[same]]], axis=1)
        found: NDArray[np.intp] = both[:, np.argsort(both[0], kind="stable")]
        return found


def joined(parts: Sequence[Landmarks]) -> Landmarks:
    """All of several, which are in one frame."""
    names = Landmarks.__slots__
    return Landmarks(*(np.concatenate([getattr(p, n) for p in parts]) for n in names))


Row = tuple[Array, float, float, bool, tuple[float, float], bool, Array, Array, float]


class Recogniser:
    """Tells landmarks from detections, as the ontology tells what things are and what moves."""

    def __init__(self, network: Network) -> None:
        self._network = network
        self._features = sorted(network.knowledge_base.features)
        categories = network.knowledge_base.categories
        kinds = [categories[name] for name in network.objects.categories]
        known = np.array([k.name != SOMETHING_ELSE for k in kinds], np.float64)
        weights = known * np.array([k.matching_weight for k in kinds])
        static = np.array([k.movability != "Dynamic" for k in kinds])
        self._share = np.stack([known * static, known * ~static])
        self._weight = np.stack([weights * static, weights * ~static])
        self._otherwise = categories[SOMETHING_ELSE].matching_weight

    def landmarks_of(self, view: View, detections: Sequence[Detection]) -> Landmarks:
        """What a placed view saw that places can be told by, in the frame of its base.

        Walls, floors and openings are not among them: these are what geometry is verified with.
        """
        assert view.T_map_base is not None
        rows = []
        for detection in detections:
            if is_structure(detection) or detection.measures.get("is_floor", 0.0):
                continue
            row = self._row(detection)
            if row is not None and row[-1] >= FAINT_WEIGHT:
                rows.append(row)
        categories = len(self._network.objects.categories)
        return _from_rows(rows, len(self._features), categories).seen_from(inverse(view.T_map_base))

    def _row(self, detection: Detection) -> Row | None:
        supports = detection.affords("SupportAbility")
        top = float(detection.position_xyz[2]) if supports else detection.box.top
        whole, size = detection.seen_whole, detection.box.size_xyz
        known = self._network.known(detection.affordances)
        try:
            belief = self._network.objects.shares(known, size, top, whole)
        except EvidenceError:  # A stranger's detector told of what nothing can be.
            return None
        width, length = sorted(size[:2])
        noise = float(np.sqrt(max(detection.covariance_xyz[0, 0], 0.0)))
        sigma = noise + WHOLE_SIGMA_M + (0.0 if whole else PART_SHARE * length)
        affords = np.array([detection.affordances.get(name, 0.0) for name in self._features])
        xy = np.asarray(detection.position_xyz[:2], np.float64)
        weight = self._matching_weight(belief)
        return xy, sigma, top, supports, (length, width), whole, affords, np.sqrt(belief), weight

    def _matching_weight(self, belief: Array) -> float:
        """As `Network.movability` has it, of the likelier of static and dynamic."""
        share, weight = self._share @ belief, self._weight @ belief
        kind = int(share[1] > share[0])
        return float(weight[kind] / share[kind]) if share[kind] > 0 else self._otherwise


def _from_rows(rows: Sequence[Row], features: int, categories: int) -> Landmarks:
    xy, sigma, top, supports, size, whole, affords, belief, weight = (
        zip(*rows, strict=True) if rows else [()] * 9
    )
    return Landmarks(
        np.array(xy, np.float64).reshape(-1, 2),
        np.array(sigma, np.float64),
        np.array(top, np.float64),
        np.array(supports, np.bool_),
        np.array(size, np.float64).reshape(-1, 2),
        np.array(whole, np.bool_),
        np.array(affords, np.float64).reshape(-1, features),
        np.array(belief, np.float64).reshape(-1, categories),
        np.array(weight, np.float64),
    )
