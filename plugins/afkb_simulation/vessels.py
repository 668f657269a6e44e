"""Small things, mostly turned about z, hollow ones with a wall of real thickness; m."""

from __future__ import annotations

from collections.abc import Mapping

from afkb_simulation.built import Built, Size, Support
from afkb_simulation.meshes import Mesh, box, ellipsoid, lathe, merge, open_box

Profile = list[tuple[float, float]]


def hollow_profile(radius: float, height: float, wall: float, floor: float) -> Profile:
    """Up the outside, over the rim, down the inside to the middle of a floor."""
    inner = radius - wall
    return [(0, 0), (radius, 0), (radius, height), (inner, height), (inner, floor), (0, floor)]


def _turned(profile: Profile, size: Size) -> Mesh:
    return lathe(profile, size[1] / size[0])


def straight(size: Size, parameters: Mapping[str, float]) -> Built:
    """An open cylinder: cup, pot, bucket, trash can."""
    wall = parameters["wall_m"]
    return Built(_turned(hollow_profile(size[0] / 2, size[2], wall, wall), size), size[2])


def mug(size: Size, parameters: Mapping[str, float]) -> Built:
    """An open cylinder with a handle on its left."""
    y, z = size[1] / 2, size[2]
    body = straight(size, parameters).mesh
    handle = [
        box((-0.006, y - 0.002, 0.7 * z), (0.006, y + 0.03, 0.82 * z)),
        box((-0.006, y - 0.002, 0.18 * z), (0.006, y + 0.03, 0.3 * z)),
        box((-0.006, y + 0.02, 0.3 * z), (0.006, y + 0.03, 0.7 * z)),
    ]
    return Built(merge([body, *handle]), z)


def bowl(size: Size, parameters: Mapping[str, float]) -> Built:
    """A vessel that widens from a narrow foot: bowl, vase."""
    r, z, wall = size[0] / 2, size[2], parameters["wall_m"]
    outside = [(0.45 * r, 0.0), (0.75 * r, 0.25 * z), (0.93 * r, 0.6 * z), (r, z)]
    inside = [(radius - wall, max(height, wall)) for radius, height in reversed(outside)]
    return Built(_turned([(0, 0), *outside, *inside, (0, wall)], size), z)


def plate(size: Size, _: Mapping[str, float]) -> Built:
    """A shallow dish."""
    r, z, wall = size[0] / 2, size[2], 0.005
    profile = [(0, 0), (0.6 * r, 0), (r, z), (r, z - 0.002), (0.6 * r, wall), (0, wall)]
    half = 0.4 * r
    return Built(_turned(profile, size), z, (Support(wall, -half, -half, half, half),))


def cylinder(size: Size, _: Mapping[str, float]) -> Built:
    """A closed cylinder: can, canister."""
    r, z = size[0] / 2, size[2]
    half = 0.7 * r
    support = Support(z, -half, -half, half, half)
    return Built(_turned([(0, 0), (r, 0), (r, z), (0, z)], size), z, (support,))


def bottle(size: Size, _: Mapping[str, float]) -> Built:
    """A closed body with shoulders and a neck."""
    r, z = size[0] / 2, size[2]
    neck = 0.38 * r
    profile = [(0, 0), (r, 0), (r, 0.6 * z), (neck, 0.78 * z), (neck, z), (0, z)]
    return Built(_turned(profile, size), z)


def ball(size: Size, _: Mapping[str, float]) -> Built:
    """A ball or, flattened, a cushion."""
    return Built(ellipsoid(size), size[2])


def open_carton(size: Size, parameters: Mapping[str, float]) -> Built:
    """A box without a lid, or a tray; what lies in it lies on its floor."""
    x, y, z, wall = size[0] / 2, size[1] / 2, size[2], parameters["wall_m"]
    mesh = open_box((-x, -y, 0), (x, y, z), wall, wall)
    return Built(mesh, z, (Support(wall, -x + wall, -y + wall, x - wall, y - wall),))
