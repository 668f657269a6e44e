"""What a thing affords because of what it probably is: materials above all."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from afkb.inference import Network
from afkb_grounded.seen import SURFACE, Seen


class CategoryPriors:
    """P(feature | size, height, what was detected), by the network and the categories' afbits."""

    def __init__(self, network: Network, strengths: Mapping[str, float]) -> None:
        objects = network.objects
        self._network = network
        self._features = [name for name in strengths if name in objects.features]
        self._strengths = np.array([strengths[name] for name in self._features])
        self._rates = np.array([objects.features[name] for name in self._features])

    @property
    def features(self) -> tuple[str, ...]:
        """The features that it can tell of."""
        return tuple(self._features)

    def afforded(self, things: Sequence[Seen]) -> list[dict[str, float]]:
        """Feature to probability, strength included, of each thing."""
        if not self._features or not things:
            return [{} for _ in things]
        shares = np.array([self._shares(thing) for thing in things])
        p = shares @ self._rates.T * self._strengths
        return [dict(zip(self._features, row, strict=True)) for row in p.tolist()]

    def _shares(self, thing: Seen) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
        first = thing.first
        top = float(first.position_xyz[2]) if SURFACE in thing.kinds else first.box.top
        known = self._network.known(thing.affordances)
        return self._network.objects.shares(known, first.box.size_xyz, top, first.seen_whole)
