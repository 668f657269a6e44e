"""A posterior, piece of evidence by piece of evidence, and what would change it most."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from afkb.explaining.source import Source

Array = NDArray[np.float64]
Belief = dict[str, float]
SHOWN = 3
"""So many states are told of, the likeliest ones; JSON has the posterior of all."""


@dataclass(frozen=True, slots=True, eq=False)
class Row:
    """A piece of evidence: its `name`, what was `observed`, and P(observed | state), (S,).

    `sources`: state to the statements behind that likelihood.
    """

    name: str
    observed: str
    likelihood: Array
    sources: Callable[[str], tuple[Source, ...]]


@dataclass(frozen=True, slots=True, eq=False)
class WhatIf:
    """What would be believed if one thing were otherwise.

    `what`: in words; `probability`: of that, by all that is known, None where it can't be told;
    `moved`: share of the belief that moves to other states (total variation distance).
    """

    what: str
    probability: float | None
    posterior: Belief
    moved: float
    flips_to: str | None = None


@dataclass(frozen=True, slots=True, eq=False)
class Chain:
    """From a prior over states, row by row, to the posterior.

    `stored`: what the map states, some or all states; `prior`: (S,).
    """

    states: tuple[str, ...]
    prior: Array
    prior_sources: Callable[[str], tuple[Source, ...]]
    rows: tuple[Row, ...]
    stored: Mapping[str, float]
    what_if: tuple[WhatIf, ...] = ()

    @property
    def posterior(self) -> Belief:
        """What prior and rows make together."""
        return as_belief(self.states, self.steps()[-1])

    def steps(self) -> list[Array]:
        """The belief (S,) before any evidence and after each row, each summing to 1."""
        found = [normalised(self.prior)]
        for row in self.rows:
            found.append(normalised(found[-1] * row.likelihood))
        return found

    @property
    def off_by(self) -> float:
        """How far the posterior is from what the map states, at most."""
        posterior = self.posterior
        return max((abs(posterior.get(n, 0.0) - p) for n, p in self.stored.items()), default=0.0)

    def likeliest(self, count: int = SHOWN) -> list[str]:
        """The states that the posterior holds for likeliest."""
        posterior = self.posterior
        return sorted(self.states, key=lambda s: (-posterior[s], s))[:count]


def normalised(weights: Array) -> Array:
    """Weights as shares that sum to 1; of evidence that no state can give, an even belief."""
    total = float(weights.sum())
    if not total > 0:
        return np.full(len(weights), 1.0 / len(weights))
    return np.asarray(weights / total)


def as_belief(states: Sequence[str], shares: Array) -> Belief:
    """State to probability."""
    return dict(zip(states, shares.tolist(), strict=True))


def if_otherwise(
    what: str, before: Mapping[str, float], after: Belief, probability: float | None = None
) -> WhatIf:
    """What a change of belief comes to."""
    moved = sum(abs(after.get(n, 0.0) - before.get(n, 0.0)) for n in {*before, *after}) / 2
    first, now = (max(sorted(b), key=lambda n: b[n]) for b in (before, after))
    return WhatIf(what, probability, after, moved, now if now != first else None)


def left_out(chain: Chain) -> list[WhatIf]:
    """What would be believed without each of the rows."""
    before = chain.posterior
    found = []
    for left in chain.rows:
        weights = chain.prior.copy()
        for row in chain.rows:
            if row is not left:
                weights = weights * row.likelihood
        after = as_belief(chain.states, normalised(weights))
        found.append(if_otherwise(f"without {left.name}: {left.observed}", before, after))
    return found


def most_telling(found: Sequence[WhatIf], count: int) -> tuple[WhatIf, ...]:
    """Those that move most, weighed by how probable they are; equals by name."""

    def weight(what_if: WhatIf) -> float:
        return what_if.moved * (1.0 if what_if.probability is None else what_if.probability)

    return tuple(sorted(found, key=lambda w: (-weight(w), w.what))[:count])
