"""What a surface ends at in the image: something, or nothing the sensor could return."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.kernels import kernel

STRIDE_PX = 3
REACH_PX = 6
"""How far beyond its border a surface is looked for missing depth; wider than speckle."""


@kernel
def missing_border_fractions(
    depth_m: NDArray[np.float32], labels: NDArray[np.int32], n_labels: int
) -> NDArray[np.float64]:
    """Share of each label's border (n_labels,) beyond which the sensor returned nothing.

    A border pixel looks REACH_PX outwards along its row and column; single lost pixels are
    skipped, a run of them counts as missing.
    """
    height, width = labels.shape
    border, missing = np.zeros(n_labels), np.zeros(n_labels)
    for v in range(0, height, STRIDE_PX):
        for u in range(0, width, STRIDE_PX):
            label = labels[v, u]
            if label <= 0:
                continue
            for du, dv in ((1, 0), (-1, 0), (0, 1), (0, -1)):
                i, j = v + dv * 2, u + du * 2
                if not (0 <= i < height and 0 <= j < width) or labels[i, j] == label:
                    continue
                lost = same = 0
                for k in range(1, REACH_PX + 1):
                    i, j = v + dv * k, u + du * k
                    if 0 <= i < height and 0 <= j < width:
                        lost += depth_m[i, j] <= 0
                        same += labels[i, j] == label
                if same >= REACH_PX // 2:
                    continue
                border[label] += 1
                missing[label] += lost >= REACH_PX - 2
    out = np.zeros(n_labels)
    for k in range(n_labels):
        if border[k] > 0:
            out[k] = missing[k] / border[k]
    return out
