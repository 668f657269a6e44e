"""Whether a thing that was seen still is where it was: a filter over time, view after view.

The persistence filter of Rosen, Mason and Leonard (ICRA 2016): a thing is there until some moment,
of which only a prior is known, and then is gone for good; sightings and looks that should have seen
it tell which. With a constant hazard, as here, their posterior is what a two-state Bayes filter
gives: probability decays between looks, and a look multiplies the odds by its likelihood ratio. A
thing that comes back is a new thing.

The hazard follows from the ontology: the weight that a thing of some category has when maps are
matched (paper §II.D.i: about 0.3 for what is dynamic) is the probability that it stays a week.
"""

from __future__ import annotations

import math

from afkb.inference.existence import EMPTY_LIKELIHOOD_RATIO, OVERLOOKED_LIKELIHOOD_RATIO
from afkb.inference.update_rules import CERTAIN, against

WEEK_S = 7 * 24 * 3600.0
"""How long a thing stays with the probability that the ontology states as its matching weight."""
MOST_STEADFAST = 0.99
"""Weight of what never moves by itself: homes are refurnished once in two years or so."""
HOUR_S = 3600.0
"""After an hour a look from where something was looked at before tells of it anew."""
AGED_EVERY_S = 600.0
"""How often beliefs are aged; within ten minutes the least steadfast lose a thousandth."""

MET_LIKELIHOOD_RATIO = 5.0
"""P(depth meets its shape | there) over P(the same | gone): something as large has come."""
GONE_BELOW = 0.2
"""What is less probable than this is taken to be gone, or never to have been."""


def hazard_of(matching_weight: float) -> float:
    """Rate, 1/s, at which things of this weight (0..1) are moved or taken away.

    >>> round(aged(1.0, WEEK_S, hazard_of(0.3)), 6)
    0.3
    """
    return -math.log(min(max(matching_weight, 1e-3), MOST_STEADFAST)) / WEEK_S


def aged(existence: float, seconds: float, hazard: float) -> float:
    """Probability after a time in which nobody looked."""
    return existence * math.exp(-hazard * max(seconds, 0.0))


def seen_through(existence: float) -> float:
    """Probability after a look that saw what is behind it."""
    return against(existence, EMPTY_LIKELIHOOD_RATIO)


def overlooked(existence: float) -> float:
    """Probability after a look that met something there, and did not tell what."""
    return against(existence, OVERLOOKED_LIKELIHOOD_RATIO)


def met_again(existence: float) -> float:
    """Probability after a look that met something of its shape, and did not tell what."""
    return min(against(existence, MET_LIKELIHOOD_RATIO), CERTAIN)
