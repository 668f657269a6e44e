"""Whether a thing is a container, and how surely."""

from __future__ import annotations

import math
from dataclasses import dataclass

from afkb.flow import View
from afkb_containers.noise import Noise, noise_of
from afkb_containers.settings import ContainerSettings
from afkb_containers.silhouette import Silhouette, silhouette_of
from afkb_containers.solid import compact, convex, ramp, whole
from afkb_containers.spread import UNKNOWN, Spread, spread_of
from afkb_mapping.bodies import Body, Stand
from afkb_mapping.openings import Opening, Top, look_at_top
from afkb_mapping.order_statistics import percentile
from afkb_mapping.trapezoids import membership

LEAST_CLAIM = 0.1
EDGE_SHARE = 1 / 525
"""Width of the mixed edge of a body, as a share of the focal length: a pixel of a Kinect's."""
CUT = 0.5
"""A body that the image edge cuts shows neither its top nor its thickness."""
SOLID = {Stand.ON_SUPPORT: 0.85, Stand.HIDDEN: 0.72, Stand.ON_FLOOR: 0.0}
"""How often a compact, upright body holds something. On the floor such bodies are stools and
cabinets as often as boxes, so that only an opening counts there."""
FLOATS = (0.20, 0.40)
"""How far above its support its lowest part is seen, as a share of its height: what hangs there is
a lampshade or a shelf."""
FLAT = (0.25, 0.50)
"""Share of what is seen of a low body from above that is its top: cushions have but a summit."""
ROUGH = (1.5, 2.2)
"""Roughness of a body, see `Noise`: above the second it is a rack or a plant."""
CLOSED_UNSEEN = 0.8
"""How often a container is closed if nothing is seen of its top."""
LID = (0.4, 0.8)
"""Share of sight lines that end on its top: all of an open thing go in, all of a closed one end."""
SHALLOW = (0.15, 0.35)
"""Share of what sight lines could show of a hollow, up to which it is the dent of a lid."""
DENT = (0.05, 0.10)
"""Depth seen over the height of a thing: less is a dent in the top of something tall."""
RIM_SHARE = (0.5, 0.8)
INSIDE_SHARE = 0.15
SIGHT_SHARE = 0.6
"""Share of what a sight line could show of an opening, from which it is taken for deep."""


@dataclass(frozen=True, slots=True)
class Looks:
    """All that is measured of a body; no outline where nothing else speaks for a container."""

    height_m: float
    noise: Noise
    spread: Spread
    top: Top | None
    compact: float
    outline: Silhouette | None

    @property
    def opening(self) -> Opening | None:
        """The opening in its top, if one is seen."""
        return self.top.opening if self.top else None


def look_at(
    body: Body,
    sides_m: tuple[float, float],
    view: View,
    noise_scale: float,
    settings: ContainerSettings,
) -> Looks:
    """Measure a body of such sides, seen from above, the longer first, in a view of such noise."""
    assert view.depth_m is not None and view.camera is not None
    camera_xyz = view.T_map_camera[:3, 3]
    height = max(percentile(body.points[:, 2], 98.0) - body.base_m, 1e-3)
    noise = noise_of(body, view.depth_m, noise_scale)
    edge = max(1, round(EDGE_SHARE * view.camera.fx))
    spread = spread_of(body, camera_xyz, noise.sigma_m, edge) if SOLID[body.stand] else UNKNOWN
    top = look_at_top(body, camera_xyz, sigma_m=noise.sigma_m)
    fits = SOLID[body.stand] * compact(height, sides_m[0], spread, settings)
    fits *= membership(sides_m[0], settings.closed_sides_m(body.stand))
    fits *= (1 - ramp(noise.roughness, ROUGH)) * _stands(body, height)
    if spread.lies and top is not None:
        fits *= ramp(top.area_m2 / max(math.prod(sides_m), 1e-6), FLAT)
    outline = None
    if fits > 0 or (top is not None and top.opening is not None):
        outline = silhouette_of(body, view.depth_m, view.camera.fx, noise.sigma_m)
    return Looks(height, noise, spread, top, fits, outline)


def _stands(body: Body, height_m: float) -> float:
    """How much a body stands on its support, as far as that is seen, rather than hangs above it."""
    if body.support_height_m is None:
        return 1.0
    return 1 - ramp((body.lowest_m - body.base_m) / height_m, FLOATS)


@dataclass(frozen=True, slots=True)
class Verdict:
    """Probabilities that a thing is an open, that it is a closed, and that it is a container."""

    open_p: float
    closed_p: float
    contains: float


def judge(
    body: Body, size: float, free: float, looks: Looks, settings: ContainerSettings
) -> Verdict:
    """Weigh an opening against a closed body.

    `size`: how well the thing's size fits; `free`: how freely it stands, for a closed one; 0 to 1.
    """
    if looks.outline is None:
        return Verdict(0.0, 0.0, 0.0)
    whole_p = whole(looks.outline, looks.height_m)
    open_p = 0.95 * size * whole_p * _open(body.stand, looks, settings)
    solid_p = (1 - open_p) * looks.compact * size * convex(looks.outline, looks.height_m)
    solid_p *= free * (CUT if body.cut_by_image else 1.0)
    if looks.top is None or not looks.top.tells:
        return Verdict(open_p, solid_p * CLOSED_UNSEEN, open_p + solid_p)
    closed_p = solid_p * _lidded(looks.top)
    return Verdict(open_p, closed_p, open_p + closed_p)


def _lidded(top: Top) -> float:
    """How much a top in sight is a lid: sight lines end on it, or a little below its rim."""
    lid = ramp(top.lid_share, LID)
    return lid if top.opening is None else max(lid, 1 - ramp(top.opening.sight_share, SHALLOW))


def _open(stand: Stand, looks: Looks, settings: ContainerSettings) -> float:
    """How much an opening is one that holds something."""
    opening = looks.opening
    if opening is None or opening.rim_share < RIM_SHARE[0]:
        return 0.0
    deep = membership(opening.depth_m / opening.width_m, settings.depth_over_opening)
    if opening.sight_share >= SIGHT_SHARE:
        deep = max(deep, 0.9)
    if stand is Stand.ON_FLOOR:
        deep *= membership(opening.depth_m, settings.bin_depth_m)
    deep *= ramp(opening.depth_m / looks.height_m, DENT)
    around = ramp(opening.rim_share, RIM_SHARE)
    seen = min(1.0, opening.inside_share / INSIDE_SHARE)
    return deep * (0.3 + 0.7 * around) * (0.3 + 0.7 * seen)
