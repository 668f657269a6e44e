"""How likely a distance is to be read where a map has something at another distance.

The beam model of Thrun, Burgard and Fox (Probabilistic Robotics, §6.3), with one addition: how a
reading errs tells what has changed. Something nearer than the map has it may have been put there;
to see through what the map has, it must have gone, and walls never do.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

HIT, CLEAR = 0, 1
FARTHEST_M = 5.0
"""Readings beyond are too noisy (depth) or too often cut off (laser) to tell places apart."""
STEP_M = 0.05
STEPS = int((FARTHEST_M + 2.0) / STEP_M)
"""What is expected is known up to 2 m beyond the farthest reading."""
SIGMA_M, SIGMA_PER_M = 0.08, 0.02
"""Standard deviation of reading less expectation: a cell or two of the map, and a degree."""
LASER_ROW = 0
"""Readings come in rows: that of a laser, then one for each elevation of a camera's rays."""
ELEVATIONS = np.radians(np.arange(-60.0, 31.0, 6.0))
"""Of a camera's rays, above the horizon; steps that a table's edge at 2 m spans."""
ROWS = 1 + len(ELEVATIONS)
TALL_M = 1.1
"""What stands higher is a wall or a wardrobe; seats, tables, beds and chairs' backs end below."""
NEARER_LASER, NEARER_LOW, NEARER_TALL = 0.20, 0.10, 0.05
"""Likelihood, over that of agreeing, of meeting something where the map has nothing: what a person
or a chair does; wardrobes come seldom."""
BEYOND_LASER, BEYOND_LOW, BEYOND_TALL = 0.08, 0.10, 0.05
"""... of looking through what the map has. A laser at shin height looks past thin legs."""
UNSEEN = 0.20
"""... of a camera that meets something where the map knows nothing: it may be so."""
INDEPENDENT_LASER, INDEPENDENT_DEPTH = 0.06, 0.25
"""Neighbouring readings err together: so much of one counts as evidence of its own."""


def log_likelihoods(eye_m: float, sigma_m: float = SIGMA_M) -> NDArray[np.float32]:
    """(ROWS, 2, STEPS, STEPS): by row, kind, reading and expectation, both in steps of `STEP_M`.

    0 where they agree. `eye_m`: height of the camera above the floor; `sigma_m`: standard
    deviation of a reading nearby.
    """
    read = np.arange(STEPS)[:, None] * STEP_M
    expected = np.arange(STEPS)[None] * STEP_M
    agreement = np.exp(-0.5 * ((read - expected) / (sigma_m + SIGMA_PER_M * expected)) ** 2)
    table = np.empty((ROWS, 2, STEPS, STEPS), np.float32)
    for row in range(ROWS):
        nearer, beyond = np.full_like(read, NEARER_LASER), np.full_like(expected, BEYOND_LASER)
        weight = INDEPENDENT_LASER
        if row != LASER_ROW:
            up = math.sin(ELEVATIONS[row - 1])
            nearer = np.where(eye_m + up * read > TALL_M, NEARER_TALL, NEARER_LOW)
            beyond = np.where(eye_m + up * expected > TALL_M, BEYOND_TALL, BEYOND_LOW)
            weight = INDEPENDENT_DEPTH
        least = np.where(read < expected, nearer, beyond)
        table[row, HIT] = weight * np.log(least + (1 - least) * agreement)
        free = np.where(read < expected, 1.0, agreement)
        table[row, CLEAR] = weight * np.log(beyond + (1 - beyond) * free)
    return table
