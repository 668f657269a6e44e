"""What a room is for, given counts of affordance evidence in it: the room network."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from afkb.errors import EvidenceError
from afkb.inference.bands import Array
from afkb.inference.holdings import shares_of
from afkb.knowledge import UNKNOWN_ROOM, AfNet

COUNT_BINS = ((0, 0), (1, 1), (2, 2), (3, 4), (5, 8), (9, None))
"""Counts that the network tells apart, first to last; None is without end."""


@dataclass(frozen=True, slots=True, eq=False)
class RoomNetwork:
    """Room category and share seen, with the count of each evidence class as their child.

    `prior`: (R,). `shares`: (S,), how much of the room's things was found, a hidden variable with
    an even prior: few things may be few or little seen. `counts`: evidence class to
    (bins, R, S) probabilities: a thinned negative binomial about the room's expected count.
    """

    rooms: tuple[str, ...]
    prior: Array
    shares: tuple[float, ...]
    counts: Mapping[str, Array]

    @classmethod
    def compile(cls, kb: AfNet) -> RoomNetwork:
        """The network of the rooms and expected counts that the ontology states (paper §II.F)."""
        prior = np.array([r.expected_number for r in kb.rooms.values()])
        prior /= prior.sum()
        shares = shares_of(kb)
        stated = {n for r in kb.rooms.values() for n in r.expected_counts}
        counts = {name: _count_table(kb, name, prior, shares) for name in sorted(stated)}
        return cls(rooms=tuple(kb.rooms), prior=prior, shares=shares, counts=counts)

    def posterior(self, counts: Mapping[str, int]) -> dict[str, float]:
        """P(room category | counts); an evidence class that isn't counted is unobserved.

        Raises `EvidenceError` for a name that is no counted evidence class or a bad count.
        """
        joint = self.likelihood(counts) * self.joint_prior
        weights = joint.sum(axis=1)
        total = float(weights.sum())
        if not total > 0:
            raise EvidenceError(f"no room category can hold {dict(counts)}; check expectedCount")
        return dict(zip(self.rooms, (weights / total).tolist(), strict=True))

    @property
    def joint_prior(self) -> Array:
        """(R, S) P(room, share seen) before anything is counted."""
        shares = len(self.shares)
        return np.repeat(self.prior[:, None] / shares, shares, axis=1)

    def likelihood(self, counts: Mapping[str, int]) -> Array:
        """P(counts | room, share seen), (R, S), up to one factor; ones where nothing is counted.

        Raises `EvidenceError` for a name that is no counted evidence class or a bad count.
        """
        likelihood = np.ones((len(self.rooms), len(self.shares)))
        for name in sorted(counts):
            likelihood = likelihood * self.counts[self.known(name)][bin_of(name, counts[name])]
            # Hundreds of classes would leave nothing of the smallest numbers.
            likelihood = likelihood / (likelihood.max() or 1.0)
        return likelihood

    def known(self, name: str) -> str:
        """The name, if it is a counted evidence class."""
        if name not in self.counts:
            known = ", ".join(self.counts)
            raise EvidenceError(f"{name!r} is no counted evidence class; there are: {known}")
        return name


def bin_of(name: str, count: int) -> int:
    """Index of the bin of a count of an evidence class."""
    if not (math.isfinite(count) and count == int(count) and count >= 0):
        raise EvidenceError(f"{name} has count {count}; expected a whole number, 0 or more")
    return next(i for i, (_, last) in enumerate(COUNT_BINS) if last is None or count <= last)


def _count_table(kb: AfNet, name: str, prior: Array, shares: tuple[float, ...]) -> Array:
    """(bins, R, S): a room that states no count has the mean of those that do."""
    stated = [r.expected_counts.get(name) for r in kb.rooms.values()]
    unknown = np.array([room == UNKNOWN_ROOM for room in kb.rooms])
    has = np.array([m is not None for m in stated]) & ~unknown
    means = np.array([m if m is not None else 0.0 for m in stated])
    weights = np.where(has, prior, 0.0)
    means = np.where(has, means, float(means @ weights / weights.sum()) if has.any() else 1.0)
    size = kb.evidence_classes[name].dispersion
    table = np.array([[_bins(m * share, size) for share in shares] for m in means])
    if has.any():
        mixture = np.tensordot(weights / weights.sum(), table, axes=1)
        breadth = kb.parameters["UnknownRoomBreadth"]
        table[unknown] = (1.0 - breadth) * mixture + breadth / len(COUNT_BINS)
    return np.moveaxis(table, 2, 0)


def _bins(mean: float, size: float) -> Array:
    """Probability of each bin under a negative binomial of that mean and size parameter."""
    exact = [_negative_binomial(n, mean, size) for n in range(COUNT_BINS[-1][0])]
    bins = [math.fsum(exact[first : last + 1]) for first, last in COUNT_BINS if last is not None]
    probabilities = np.array([*bins, max(0.0, 1.0 - math.fsum(bins))])
    return np.asarray(0.999 * probabilities + 0.001 / len(probabilities))


def _negative_binomial(n: int, mean: float, size: float) -> float:
    log_p = (
        math.lgamma(n + size)
        - math.lgamma(size)
        - math.lgamma(n + 1)
        + size * math.log(size / (size + mean))
        + n * math.log(mean / (size + mean))
    )
    return math.exp(log_p)
