"""Figures from few counts: drawn towards what holds in general, the more so the fewer there are."""

from __future__ import annotations

import math
from collections.abc import Mapping

ROOM_WEIGHT = 8.0
"""How many rooms the general rate counts for, beside the rooms of a category that were seen.

Chosen on held-out homes (`python -m bench.figures --weights`): from 4 to 32 the losses hardly
differ.
"""
PAIR_WEIGHT = 8.0
"""How many rooms the general rate counts for, beside those that hold the given one (proposed)."""
SUPPORT_WEIGHT = 4.0
"""How many placements the general shares count for, beside those of the thing (proposed)."""
HALF = 0.5
"""Jeffreys' prior for the general rate: half a room with, half a room without."""


def general_rate(successes: float, trials: float) -> float:
    """The rate over everything, never quite 0 or 1: mean of a Beta under Jeffreys' prior.

    >>> general_rate(0, 0), general_rate(0, 99), general_rate(99, 99)
    (0.5, 0.005, 0.995)
    """
    return (successes + HALF) / (trials + 2 * HALF)


def beta_mean(successes: float, trials: float, prior_mean: float, prior_weight: float) -> float:
    """The mean of a Beta whose prior is worth `prior_weight` trials of rate `prior_mean`.

    >>> beta_mean(0, 0, 0.25, 4), beta_mean(6, 6, 0.25, 4)
    (0.25, 0.7)
    """
    return (successes + prior_weight * prior_mean) / (trials + prior_weight)


def gamma_mean(events: float, exposure: float, prior_mean: float, prior_weight: float) -> float:
    """The mean number per room of a Poisson whose Gamma prior is worth `prior_weight` rooms.

    >>> gamma_mean(12, 6, 1.0, 4)
    1.6
    """
    return (events + prior_weight * prior_mean) / (exposure + prior_weight)


def odds_shifted(rate: float, here: float, anywhere: float) -> float:
    """A rate shifted by the odds ratio of two others: what another source sees more of here.

    >>> round(odds_shifted(0.5, here=0.2, anywhere=0.2), 9)
    0.5
    >>> round(odds_shifted(0.5, here=0.5, anywhere=0.2), 9)
    0.8
    """
    logit = _logit(rate) + _logit(here) - _logit(anywhere)
    return 1 / (1 + math.exp(-logit))


def dirichlet_means(
    counts: Mapping[str, float], shares: Mapping[str, float], prior_weight: float
) -> dict[str, float]:
    """The mean share of each outcome; the prior is worth `prior_weight` outcomes of these shares.

    `shares` sum to 1 and have every outcome of `counts`; so do the means.

    >>> dirichlet_means({"Desk": 6}, {"Desk": 0.5, "Floor": 0.5}, 4)
    {'Desk': 0.8, 'Floor': 0.2}
    """
    total = sum(counts.values()) + prior_weight
    return {o: (counts.get(o, 0) + prior_weight * share) / total for o, share in shares.items()}


def _logit(p: float) -> float:
    return math.log(p) - math.log1p(-p)
