"""What a thing is, given what it affords, its size and its height: the object network."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from afkb.errors import EvidenceError
from afkb.inference.bands import SIZE_EDGES_M, TOP_EDGES_M, Array, band_of
from afkb.inference.object_tables import (
    HEIGHT,
    LENGTH,
    TOP,
    WIDTH,
    broader_features,
    features,
    measures,
)
from afkb.knowledge import AfNet

SUPPORT = "SupportAbility"


@dataclass(frozen=True, slots=True, eq=False)
class ObjectNetwork:
    """Category with its features and measures as children; (C,) is the number of categories.

    - `prior`: (C,) share of things in a home that are of the category.
    - `features`: name to (C,) probability that a thing of the category affords it.
    - `measures`: `Length`, `Width`, `Height`, `TopHeight` to (bands, C) probabilities.
    - `implied`: feature to the broader ones, which are no further evidence beside it.
    """

    categories: tuple[str, ...]
    prior: Array
    features: Mapping[str, Array]
    measures: Mapping[str, Array]
    implied: Mapping[str, frozenset[str]]

    @classmethod
    def compile(cls, kb: AfNet) -> ObjectNetwork:
        """The network of the categories, afbits, sizes and heights that the ontology states."""
        names = tuple(kb.categories)
        prior = np.array([c.expected_number for c in kb.categories.values()])
        prior /= prior.sum()
        return cls(
            categories=names,
            prior=prior,
            features=features(kb, prior),
            measures=measures(kb),
            implied={name: broader_features(kb, name) for name in kb.features},
        )

    def observed(
        self,
        affordances: Mapping[str, float],
        size_xyz: tuple[float, float, float],
        top_height_m: float,
    ) -> tuple[dict[str, float], dict[str, int]]:
        """The evidence as the network takes it: likelihoods of features, bands of measures.

        A feature's probability p is virtual evidence with likelihoods (1 - p, p): 0.5 says
        nothing, and a feature that isn't named is unobserved. What a narrower feature that is as
        probable implies is no evidence of its own. Of what affords support only the upper surface
        is measured, so its own vertical extent is unobserved.
        """
        self.check(affordances, size_xyz, top_height_m)
        implied = self._implied_by(affordances)
        likelihoods = {
            name: float(p)
            for name, p in sorted(affordances.items())
            if name in self.features and name not in implied
        }
        width, length = sorted(size_xyz[:2])
        bands = {TOP: band_of(top_height_m, TOP_EDGES_M)}
        for name, value in ((LENGTH, length), (WIDTH, width), (HEIGHT, size_xyz[2])):
            hidden = name == HEIGHT and affordances.get(SUPPORT, 0.0) >= 0.5
            if value > 0 and not hidden:
                bands[name] = band_of(value, SIZE_EDGES_M)
        return likelihoods, bands

    def check(
        self,
        affordances: Mapping[str, float],
        size_xyz: tuple[float, float, float],
        top_height_m: float,
    ) -> None:
        """Raise `EvidenceError` for unknown features and values out of range."""
        for name, p in affordances.items():
            if name not in self.implied:
                raise EvidenceError(
                    f"{name!r} is no feature of the ontology; see `afkb ontology show`"
                )
            if not (math.isfinite(p) and 0 <= p <= 1):
                raise EvidenceError(f"{name} has probability {p}, which is not in 0..1")
        if len(size_xyz) != 3 or not all(math.isfinite(v) and v >= 0 for v in size_xyz):
            raise EvidenceError(f"size {tuple(size_xyz)}: expected three finite extents in metres")
        if not math.isfinite(top_height_m):
            raise EvidenceError(f"top height {top_height_m}: expected a finite height in metres")

    def afforded(self, affordances: Mapping[str, float]) -> list[str]:
        """The features that a thing affords rather than not, one of each chain of broader ones.

        The most probable of a chain; the narrowest where they are equally probable.
        """
        kept = {f: p for f, p in affordances.items() if f in self.implied and p >= 0.5}
        implied = self._implied_by(kept)
        return [
            name
            for name, p in sorted(kept.items())
            if name not in implied and all(kept.get(b, 0.0) <= p for b in self.implied[name])
        ]

    def _implied_by(self, affordances: Mapping[str, float]) -> set[str]:
        return {
            broader
            for name, p in affordances.items()
            if p > 0.5
            for broader in self.implied.get(name, ())
            if affordances.get(broader, 0.0) <= p
        }

    def posterior(
        self,
        affordances: Mapping[str, float],
        size_xyz: tuple[float, float, float],
        top_height_m: float,
        whole: bool = True,
    ) -> dict[str, float]:
        """P(category | evidence) in closed form; equal to variable elimination (tested).

        What isn't seen `whole` is at least as long and wide as it looks.
        """
        shares = self.shares(affordances, size_xyz, top_height_m, whole)
        return dict(zip(self.categories, shares.tolist(), strict=True))

    def shares(
        self,
        affordances: Mapping[str, float],
        size_xyz: tuple[float, float, float],
        top_height_m: float,
        whole: bool = True,
    ) -> Array:
        """`posterior` as an array (C,), in the order of `categories`."""
        weights = self.prior * self.likelihood(affordances, size_xyz, top_height_m, whole)
        total = float(weights.sum())
        if not total > 0:
            raise EvidenceError(
                f"no category can afford {dict(affordances)} at size {size_xyz} m, top at "
                f"{top_height_m} m; check the strengths of 0 and 1 in the ontology's afbits"
            )
        shares: Array = weights / total
        return shares

    def likelihood(
        self,
        affordances: Mapping[str, float],
        size_xyz: tuple[float, float, float],
        top_height_m: float,
        whole: bool = True,
    ) -> Array:
        """P(what was seen of a thing | category), (C,), but for a factor that all share."""
        likelihoods, bands = self.observed(affordances, size_xyz, top_height_m)
        weights = np.ones(len(self.categories))
        for name, p in likelihoods.items():
            weights *= p * self.features[name] + (1.0 - p) * (1.0 - self.features[name])
        for name, band in bands.items():
            larger = slice(band, None if name in (LENGTH, WIDTH) and not whole else band + 1)
            weights *= self.measures[name][larger].sum(axis=0)
        return weights
