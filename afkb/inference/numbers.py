"""How many things of a category there are, where there is any: geometric, in bins."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from afkb.inference.bands import Array

NUMBER_STARTS = (1, 2, 3, 5, 9)
"""First number of each bin of how many things of a category are found, where any is."""


def number_table(mean: Array) -> Array:
    """(bins, C, R) probability of each bin of numbers, where there is any: geometric, mean (C, R).

    A hundredth is spread evenly: nobody has counted that far.
    """
    go_on = 1.0 - 1.0 / mean
    beyond = [go_on ** (start - 1) for start in NUMBER_STARTS] + [np.zeros_like(mean)]
    shares = np.array([here - after for here, after in pairwise(beyond)])
    return np.asarray(0.99 * shares + 0.01 / len(NUMBER_STARTS))
