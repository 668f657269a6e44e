"""How likely a distance is to be read where a map has something at another distance.

The beam model of Thrun, Burgard and Fox (Probabilistic Robotics, §6.3), with one addition: how a
reading errs tells what has changed. Something nearer than the map has it may have been put there;
to see through what the map has, it must have gone, and walls never do.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.localisation.bands import ANY, BANDS, SCAN, TALL

HIT, CLEAR = 0, 1
FARTHEST_M = 6.0
"""Readings beyond are too noisy (depth) or too often cut off (laser) to tell places apart."""
STEP_M = 0.05
STEPS = int((FARTHEST_M + 2.0) / STEP_M)
"""What is expected is known up to 2 m beyond the farthest reading."""
SIGMA_M, SIGMA_PER_M = 0.10, 0.02
"""Standard deviation of reading less expectation: a cell or two of the map, and a degree."""
NEARER = {SCAN: 0.20, ANY: 0.25, TALL: 0.10}
"""Likelihood, over that of agreeing, of meeting something where the map has nothing: what a person
or a chair does; wardrobes come seldom."""
BEYOND = {SCAN: 0.08, ANY: 0.03, TALL: 0.10}
"""... of looking through what the map has. A laser at shin height looks past thin legs."""


def log_likelihoods(sigma_m: float = SIGMA_M) -> NDArray[np.float32]:
    """(BANDS, 2, STEPS, STEPS): by band, kind, reading and expectation, both in steps of `STEP_M`.

    0 where they agree. `sigma_m`: standard deviation of a reading nearby.
    """
    read = np.arange(STEPS)[:, None] * STEP_M
    expected = np.arange(STEPS)[None] * STEP_M
    sigma = sigma_m + SIGMA_PER_M * expected
    agreement = np.exp(-0.5 * ((read - expected) / sigma) ** 2)
    table = np.empty((BANDS, 2, STEPS, STEPS), np.float32)
    for band in range(BANDS):
        least = np.where(read < expected, NEARER[band], BEYOND[band])
        table[band, HIT] = np.log(least + (1 - least) * agreement)
        free = np.where(read < expected, 1.0, agreement)
        table[band, CLEAR] = np.log(BEYOND[band] + (1 - BEYOND[band]) * free)
    return table
