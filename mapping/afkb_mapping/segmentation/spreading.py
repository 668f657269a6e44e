"""Labels grown into what lies beside them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Labels = NDArray[np.int32]


def spread(labels: Labels, within: NDArray[np.bool_]) -> Labels:
    """(rows, cols) labels grown step by step into the unlabelled cells of `within` they touch."""
    labels = np.pad(labels, 1)
    empty = np.pad(within, 1) & (labels == 0)
    while empty.any():
        rows, cols = np.nonzero(empty)
        beside = [labels[rows + dr, cols + dc] for dr, dc in ((0, 1), (0, -1), (1, 0), (-1, 0))]
        found = np.max(beside, axis=0)
        if not found.any():
            break
        labels[rows, cols] = found
        empty[rows, cols] = found == 0
    return labels[1:-1, 1:-1]
