"""What is measured of a body before it is judged."""

from __future__ import annotations

import math
from dataclasses import dataclass

from afkb_containers.clearance import Above, above
from afkb_containers.edges import edges_of
from afkb_containers.noise import Noise, noise_of
from afkb_containers.settings import ContainerSettings
from afkb_containers.sight import Sight
from afkb_containers.silhouette import Silhouette, silhouette_of
from afkb_containers.solid import compact, sized
from afkb_containers.spread import UNKNOWN, Spread, spread_of
from afkb_mapping.bodies import Body, Stand
from afkb_mapping.openings import Opening, Top, look_at_top
from afkb_mapping.order_statistics import percentile
from afkb_mapping.trapezoids import membership, ramp

LEAST_CLAIM = 0.2
"""What holds something in fewer cases is not told of: it would tell nothing, and often wrongly."""
RIM_SHARE = (0.5, 0.8)
"""Share of the way around an opening at which there is rim: none below, fully sure above."""
EDGE_SHARE = 1 / 525
"""Width of the mixed edge of a body, as a share of the focal length: a pixel of a Kinect's."""
SOLID = {Stand.ON_SUPPORT: 0.92, Stand.HIDDEN: 0.80, Stand.ON_FLOOR: 0.0}
"""How often a compact, upright body holds something. On the floor such bodies are stools and
cabinets as often as boxes, so that only an opening counts there."""
FLOATS = (0.20, 0.40)
"""How far above its support its lowest part is seen, as a share of its height: what hangs there is
a lampshade or a shelf."""
FLAT = (0.25, 0.50)
"""Share of what is seen of a low body from above that is its top: cushions have but a summit."""
DETACHED = (0.20, 0.45)
"""Share of its outline, above the foot, at which a body ends before something farther: what goes
on at the same depth all around is a part of furniture, or lies flat on a wall."""
BEHIND = (0.30, 0.60)
"""Share of its outline that something nearer hides: above the second, one sees a part of it."""
FILLED = (0.25, 0.50)
"""Share of what is right above a body that isn't free: under a lamp's shade, or below a board that
it carries, all of it; noise and what stands before it fill a little."""
UNSEEN_ABOVE, OUTSIDE_ABOVE = 0.75, 0.5
"""How often the space above is free where it isn't seen; where it is beyond the image, the body may
go on there as well."""
ROUGH = (1.5, 2.2)
"""Roughness of a body, see `Noise`: above the second it is a rack or a plant."""


@dataclass(frozen=True, slots=True)
class Looks:
    """All that is measured of a body; no outline where nothing else speaks for a container.

    - `compact`: how much it has the measures of a can or carton, `detached`: how much its outline
      is its own, and `clear`: how free it is above; 0 to 1.
    """

    height_m: float
    noise: Noise
    spread: Spread
    top: Top | None
    compact: float
    outline: Silhouette | None
    detached: float
    clear: float

    @property
    def opening(self) -> Opening | None:
        """The opening in its top, if one is seen."""
        return self.top.opening if self.top else None


def look_at(
    body: Body,
    sides_m: tuple[float, float],
    cut: bool,
    sight: Sight,
    settings: ContainerSettings,
) -> Looks:
    """Measure a body of such sides, seen from above, the longer first; the image may `cut` it.

    What nothing yet measured leaves a chance is not measured further.
    """
    height = max(percentile(body.points[:, 2], 98.0) - body.base_m, 1e-3)
    noise = noise_of(body, sight.depth_m, sight.noise_scale)
    top = look_at_top(body, sight.camera_xyz, sigma_m=noise.sigma_m)
    fits = _sized(body, height, sides_m, settings) * (1 - ramp(noise.roughness, ROUGH))
    spread, detached, clear, outline = UNKNOWN, 0.0, 0.0, None
    if fits > 0:
        edges = edges_of(body, sight.depth_m, max(1, round(EDGE_SHARE * sight.focal_px)))
        spread = spread_of(body, sight.camera_xyz, noise.sigma_m, edges.inner, cut)
        fits *= compact(height, spread, settings)
        detached = ramp(edges.free, DETACHED) * (1 - ramp(edges.hidden, BEHIND))
    if spread.lies and top is not None:
        fits *= ramp(top.area_m2 / max(math.prod(sides_m), 1e-6), FLAT)
    if fits * detached >= LEAST_CLAIM:
        clear = _clear(above(body, body.base_m + height, sight))
    opens = top is not None and top.opening is not None and top.opening.rim_share >= RIM_SHARE[0]
    if opens or fits * detached * clear >= LEAST_CLAIM:
        outline = silhouette_of(body, sight.depth_m, sight.focal_px, noise.sigma_m)
    return Looks(height, noise, spread, top, fits, outline, detached, clear)


def _sized(
    body: Body, height_m: float, sides_m: tuple[float, float], settings: ContainerSettings
) -> float:
    """How much a body has the size and the stand of a closed one, 0 to 1."""
    fits = SOLID[body.stand] * membership(sides_m[0], settings.closed_sides_m(body.stand))
    return fits * sized(height_m, sides_m[0], settings) * _stands(body, height_m)


def _clear(over: Above) -> float:
    """How much nothing lies on a body's top or hangs over it, 0 to 1."""
    unseen = 1 - over.free - over.filled - over.outside
    doubt = (1 - UNSEEN_ABOVE) * unseen + (1 - OUTSIDE_ABOVE) * over.outside
    return (1 - ramp(over.filled, FILLED)) * (1 - doubt)


def _stands(body: Body, height_m: float) -> float:
    """How much a body stands on its support, as far as that is seen, rather than hangs above it."""
    if body.support_height_m is None:
        return 1.0
    return 1 - ramp((body.lowest_m - body.base_m) / height_m, FLOATS)
