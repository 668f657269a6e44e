"""How a camera's optical frame sits in its body frame (REP-103, REP-105)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

# Body: x ahead, y left, z up. Optical: x right, y down, z forward. A pure rotation.
T_BODY_OPTICAL: NDArray[np.float64] = np.array(
    [[0, 0, 1, 0], [-1, 0, 0, 0], [0, -1, 0, 0], [0, 0, 0, 1]], dtype=np.float64
)
T_OPTICAL_BODY: NDArray[np.float64] = T_BODY_OPTICAL.T.copy()
for _T in (T_BODY_OPTICAL, T_OPTICAL_BODY):
    _T.setflags(write=False)
