"""What counts as a thing: physical limits of bodies that stand somewhere."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class ThingSettings:
    """Limits of the thing detector, m.

    - `above_m`: lowest and highest point of a thing over its support that is looked at.
    - `core_m`: what rises less over its support, a magazine or a cloth, joins nothing.
    - `min_pixels`: fewer show no shape. `cell_m`: what is nearer, seen from above, touches.
    """

    above_m: tuple[float, float] = (0.012, 0.50)
    core_m: float = 0.032
    min_pixels: int = 90
    cell_m: float = 0.01
