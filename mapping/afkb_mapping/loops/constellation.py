"""Things seen again: which of a view's landmarks are which of the map's, and where it then stood.

Every pair that may be one thing is an assignment. Assignments agree where the things stand as far
from each other in the view as in the map; the heaviest set that all agree is a maximum clique
(Bailey 2002). Movable things weigh little (paper §II.D.i).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import networkx as nx
import numpy as np
from numpy.typing import NDArray

from afkb_mapping.geometry import T_from_xy_yaw, transform_xy, yaw_of
from afkb_mapping.loops.landmarks import SAME_TOP_M, Landmarks

Array = NDArray[np.float64]

SAME_SIZE, SIZE_NOISE_M = 0.3, 0.06
"""Extents of one thing that both have seen whole agree within this share and this much, m."""
SAME_KIND = 0.5
"""Bhattacharyya coefficient of what two landmarks may be, from which they may be one thing."""
LEAST_WEIGHT = 2.0
"""Two things that never move, or seven that do, tell a place, if they stand apart by more than"""
LEAST_SPREAD_M = 1.0
PART_WEIGHT = 0.5
"""What was seen in part tells half as much: its middle is not where it seems."""
UNIQUE = 0.75
"""A place is ambiguous if another one explains this share of the landmarks' weight as well;"""
ANOTHER_M, ANOTHER_RAD = 0.5, math.radians(15)
"""and another place is further from it than this."""
MOST_ASSIGNMENTS = 40
"""A clique is sought among so many, the weightiest ones: rooms hold fewer."""


@dataclass(frozen=True, slots=True, eq=False)
class Recognition:
    """Which landmarks are which, and what follows.

    - `pairs`: (P, 2) index in the view, index in the map. `weight`: sum over them of 0..1.
    - `T_known_view`: 4x4. `runner_up`: weight of the best other place.
    """

    pairs: NDArray[np.intp]
    weight: float
    T_known_view: Array
    runner_up: float = 0.0

    @property
    def is_ambiguous(self) -> bool:
        """Whether another place looks nearly the same."""
        return self.runner_up >= UNIQUE * self.weight


def recognised(
    view: Landmarks, known: Landmarks, T_start: Array, sigmas: Array
) -> Recognition | None:
    """The view's landmarks among the known ones; None where too few agree.

    `T_start` (4, 4) and `sigmas` (3,) m, m, rad: where the view is expected, and how surely.
    """
    if not len(view) or not len(known):
        return None
    weights = pair_weights(view, known, _within_reach(view, known, T_start, sigmas))
    best = _heaviest(weights, view, known)
    if best is None:
        return None
    moved = transform_xy(best.T_known_view, view.xy)
    off = np.hypot(*(moved[:, None] - known.xy[None]).transpose(2, 0, 1))
    second = _heaviest(weights * (off > ANOTHER_M), view, known)
    if second is None or not _is_another(best.T_known_view, second.T_known_view):
        return best
    return Recognition(best.pairs, best.weight, best.T_known_view, second.weight)


def pair_weights(view: Landmarks, known: Landmarks, among: NDArray[np.bool_]) -> Array:
    """(A, B) how much it tells that a view's landmark is a known one; 0 where it can't be.

    `among`: (A, B) the pairs that are asked about.
    """
    level = np.abs(view.top_m[:, None] - known.top_m[None]) <= SAME_TOP_M
    same = among & level & (view.is_surface[:, None] == known.is_surface[None])
    for axis in range(2):
        mine, other = view.size_m[:, None, axis], known.size_m[None, :, axis]
        slack = SIZE_NOISE_M + SAME_SIZE * np.maximum(mine, other)
        same &= ~(view.whole[:, None] & (other - mine > slack))
        same &= ~(known.whole[None] & (mine - other > slack))
    a, b = np.nonzero(same)
    kind = np.einsum("nc,nc->n", view.root_belief[a], known.root_belief[b])
    parts = np.where(view.whole, 1.0, PART_WEIGHT)[a] * np.where(known.whole, 1.0, PART_WEIGHT)[b]
    weights = np.zeros(same.shape)
    told = kind * parts * np.minimum(view.weight[a], known.weight[b])
    weights[a, b] = np.where(kind >= SAME_KIND, told, 0.0)
    return weights


def _within_reach(
    view: Landmarks, known: Landmarks, T_start: Array, sigmas: Array
) -> NDArray[np.bool_]:
    """(A, B) whether a landmark may have been seen there, as sure as the robot's pose is."""
    swing = np.hypot(float(sigmas[:2].max()), float(sigmas[2]) * np.hypot(*view.xy.T))
    reach = 3 * swing[:, None] + view.sigma_m[:, None] + known.sigma_m[None]
    expected = transform_xy(T_start, view.xy)
    off = np.hypot(*(expected[:, None] - known.xy[None]).transpose(2, 0, 1))
    within: NDArray[np.bool_] = off <= reach
    return within


def _heaviest(weights: Array, view: Landmarks, known: Landmarks) -> Recognition | None:
    """The heaviest set of assignments (A, B) that agree, and the pose that follows."""
    a, b = np.nonzero(weights > 0)
    order = np.argsort(-weights[a, b], kind="stable")[:MOST_ASSIGNMENTS]
    a, b = a[order], b[order]
    if len(a) < 2:
        return None
    graph: nx.Graph[int] = nx.Graph()
    for k, weight in enumerate(weights[a, b].tolist()):
        graph.add_node(k, weight=max(1, round(1000 * weight)))
    rows, columns = np.nonzero(np.triu(_agreeing(a, b, view, known), 1))
    graph.add_edges_from(zip(rows.tolist(), columns.tolist(), strict=True))
    clique, _ = nx.max_weight_clique(graph)
    chosen = np.array(sorted(clique), np.intp)
    a, b = a[chosen], b[chosen]
    total = float(weights[a, b].sum())
    spread = np.hypot(*(view.xy[a][:, None] - view.xy[a][None]).transpose(2, 0, 1)).max()
    if spread < LEAST_SPREAD_M or total < LEAST_WEIGHT:
        return None
    return Recognition(np.column_stack([a, b]), total, _pose(a, b, view, known))


def _agreeing(
    a: NDArray[np.intp], b: NDArray[np.intp], view: Landmarks, known: Landmarks
) -> NDArray[np.bool_]:
    """(K, K) whether two assignments keep their distance; no thing is two things."""
    mine = np.hypot(*(view.xy[a][:, None] - view.xy[a][None]).transpose(2, 0, 1))
    other = np.hypot(*(known.xy[b][:, None] - known.xy[b][None]).transpose(2, 0, 1))
    variance = view.sigma_m[a] ** 2 + known.sigma_m[b] ** 2
    agree: NDArray[np.bool_] = np.abs(mine - other) <= 2 * np.sqrt(
        variance[:, None] + variance[None]
    )
    agree &= (a[:, None] != a[None]) & (b[:, None] != b[None])
    return agree


def _pose(a: NDArray[np.intp], b: NDArray[np.intp], view: Landmarks, known: Landmarks) -> Array:
    """Least squares pose that lays the view's landmarks on the known ones (Umeyama 1991)."""
    w = 1 / (view.sigma_m[a] ** 2 + known.sigma_m[b] ** 2)
    w /= w.sum()
    p, q = view.xy[a], known.xy[b]
    mean_p, mean_q = w @ p, w @ q
    p, q = p - mean_p, q - mean_q
    cross = float(w @ (p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0]))
    T = T_from_xy_yaw(0.0, 0.0, math.atan2(cross, float(w @ (p * q).sum(axis=1))))
    T[:2, 3] = mean_q - T[:2, :2] @ mean_p
    return T


def _is_another(T_a: Array, T_b: Array) -> bool:
    T = np.linalg.inv(T_a) @ T_b
    return bool(np.hypot(T[0, 3], T[1, 3]) > ANOTHER_M or abs(yaw_of(T)) > ANOTHER_RAD)
