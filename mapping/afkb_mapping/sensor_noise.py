"""How wrong a structured-light depth is, by distance."""

from __future__ import annotations

from afkb_mapping.kernels import kernel

FLOOR_M = 0.0012
GROWTH_PER_M = 0.0019
NEAREST_M = 0.4


@kernel
def depth_sigma(z_m: float) -> float:
    """Standard deviation of a depth of z_m, m (axial noise of Nguyen et al., 3DIMPVT 2012).

    It includes the rounding to steps of disparity, about 11 mm at 2 m.
    """
    off = z_m - NEAREST_M
    return FLOOR_M + GROWTH_PER_M * off * off
