"""A map from which a share of the low things is gone, as if they had been brought in since."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.ndimage import label

from afkb_mapping.localisation.bands import FREE, STANDS, UNKNOWN, HeightBands
from afkb_mapping.localisation.sensor_model import TALL_M
from afkb_mapping.localisation.slabs import SLAB_M

FLOOR_SLABS = 2


def without(bands: HeightBands, share: float, rng: np.random.Generator) -> HeightBands:
    """The bands without a share of what stands by itself and is not tall.

    What stands in neighbouring cells is one thing. A view then sees what the map has not: to a
    robot the same as furniture that was moved in.
    """
    stands = bands.slabs == STANDS
    stands[..., :FLOOR_SLABS] = False
    tall = stands[..., round(TALL_M / SLAB_M) :].any(axis=2)
    low = stands.any(axis=2) & ~tall
    things, count = label(low, np.ones((3, 3)))
    gone = rng.random(count + 1) < share
    gone[0] = False
    cleared = gone[things]
    slabs, scan = bands.slabs.copy(), bands.scan.copy()
    slabs[cleared] = np.where(slabs[cleared] == UNKNOWN, UNKNOWN, FREE)
    scan[cleared & (scan == STANDS)] = FREE
    return replace(bands, slabs=slabs, scan=scan)
