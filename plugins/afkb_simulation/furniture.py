"""Furniture from boxes: x to the front, y to the left, z up, m."""

from __future__ import annotations

from collections.abc import Mapping

from afkb_simulation.built import Built, Size, Support
from afkb_simulation.meshes import Mesh, box, lathe, merge, open_box, rounded_bar
from afkb_simulation.vessels import hollow_profile

_BOARD = 0.02
_LEG = 0.05


def _legs(x0: float, y0: float, x1: float, y1: float, height: float) -> list[Mesh]:
    xs, ys = (x0, x1 - _LEG), (y0, y1 - _LEG)
    return [box((x, y, 0), (x + _LEG, y + _LEG, height)) for x in xs for y in ys]


def solid(size: Size, _: Mapping[str, float]) -> Built:
    """A closed box: block, book, carton, wardrobe, cabinet."""
    x, y, z = size[0] / 2, size[1] / 2, size[2]
    return Built(box((-x, -y, 0), (x, y, z)), z, (Support(z, -x, -y, x, y),))


def table(size: Size, _: Mapping[str, float]) -> Built:
    """A board on four legs."""
    x, y, z = size[0] / 2, size[1] / 2, size[2]
    board = box((-x, -y, z - 0.03), (x, y, z))
    legs = _legs(-x + 0.02, -y + 0.02, x - 0.02, y - 0.02, z - 0.03)
    return Built(merge([board, *legs]), z, (Support(z, -x, -y, x, y),))


def chair(size: Size, parameters: Mapping[str, float]) -> Built:
    """A seat on four legs with a back rest at the rear."""
    x, y, z, seat = size[0] / 2, size[1] / 2, size[2], parameters["seat_m"]
    parts = [
        box((-x, -y, seat - 0.04), (x, y, seat)),
        rounded_bar((-x, -y, seat), (-x + 0.04, y, z), along=1),
        *_legs(-x, -y, x, y, seat - 0.04),
    ]
    return Built(merge(parts), seat, (Support(seat, -x + 0.04, -y, x, y),))


def couch(size: Size, parameters: Mapping[str, float]) -> Built:
    """A deep seat between padded arms and a padded back."""
    x, y, z, seat = size[0] / 2, size[1] / 2, size[2], parameters["seat_m"]
    back, arm, arm_top = 0.25, 0.18, min(size[2], seat + 0.2)
    parts = [
        *_legs(-x, -y, x, y, 0.05),
        box((-x, -y, 0.05), (x, y, seat)),
        rounded_bar((-x, -y, seat), (-x + back, y, z), along=1),
        rounded_bar((-x + back, -y, seat), (x, -y + arm, arm_top), along=0),
        rounded_bar((-x + back, y - arm, seat), (x, y, arm_top), along=0),
    ]
    return Built(merge(parts), seat, (Support(seat, -x + back, -y + arm, x, y - arm),))


def bed(size: Size, parameters: Mapping[str, float]) -> Built:
    """A frame with a mattress, and a headboard at the rear."""
    x, y, z = size[0] / 2, size[1] / 2, size[2]
    headboard = max(z, parameters["headboard_m"])
    parts = [
        *_legs(-x, -y, x, y, 0.08),
        box((-x, -y, 0.08), (x, y, z - 0.2)),
        box((-x + 0.05, -y + 0.02, z - 0.2), (x - 0.02, y - 0.02, z)),
        rounded_bar((-x, -y, z - 0.2), (-x + 0.05, y, headboard), along=1),
    ]
    return Built(merge(parts), z, (Support(z, -x + 0.05, -y + 0.02, x - 0.02, y - 0.02),))


def counter(size: Size, _: Mapping[str, float]) -> Built:
    """A run of base cabinets under one worktop, with a recess for the toes."""
    x, y, z = size[0] / 2, size[1] / 2, size[2]
    parts = [
        box((-x, -y, 0), (x - 0.08, y, 0.1)),
        box((-x, -y, 0.1), (x - 0.02, y, z - 0.04)),
        box((-x, -y, z - 0.04), (x, y, z)),
    ]
    return Built(merge(parts), z, (Support(z, -x, -y, x, y),))


def shelf(size: Size, parameters: Mapping[str, float]) -> Built:
    """Open boards between two sides and a back; the supports run from the top board down."""
    x, y, z, n = size[0] / 2, size[1] / 2, size[2], int(parameters["boards"])
    heights = [z - k * (z - 0.1) / max(1, n - 1) for k in range(n)]
    sides = [
        box((-x, -y, 0), (x, -y + _BOARD, z - _BOARD)),
        box((-x, y - _BOARD, 0), (x, y, z - _BOARD)),
        box((-x, -y + _BOARD, 0), (-x + 0.01, y - _BOARD, z - _BOARD)),
    ]
    boards = [box((-x, -y, h - _BOARD), (x, y, h)) for h in heights]
    supports = tuple(Support(h, -x + 0.01, -y + _BOARD, x, y - _BOARD) for h in heights)
    return Built(merge([*sides, *boards]), z, supports)


def bathtub(size: Size, parameters: Mapping[str, float]) -> Built:
    """A hollow tub; what lies in it lies on its floor."""
    x, y, z, wall = size[0] / 2, size[1] / 2, size[2], parameters["wall_m"]
    mesh = open_box((-x, -y, 0), (x, y, z), wall, 0.15)
    return Built(mesh, z, (Support(0.15, -x + wall, -y + wall, x - wall, y - wall),))


def sink(size: Size, parameters: Mapping[str, float]) -> Built:
    """A basin on a pedestal, with a ledge at the rear where a cup can stand."""
    x, y, z, wall = size[0] / 2, size[1] / 2, size[2], parameters["wall_m"]
    ledge = -x + 0.12
    parts = [
        box((-x, -0.09, 0), (-x + 0.2, 0.09, z - 0.18)),
        box((-x, -y, z - 0.18), (ledge, y, z)),
        open_box((ledge, -y, z - 0.18), (x, y, z), wall, 0.04),
    ]
    return Built(merge(parts), z, (Support(z, -x, -y, ledge, y),))


def toilet(size: Size, _: Mapping[str, float]) -> Built:
    """A bowl with a cistern at the rear."""
    x, y, z, rim = size[0] / 2, size[1] / 2, size[2], 0.41
    rear = -x + 0.18
    bowl = lathe(hollow_profile((x - rear) / 2, rim, 0.05, 0.2), 2 * y / (x - rear))
    bowl.vertices[:, 0] += (x + rear) / 2
    parts = [bowl, box((-x, -y, 0.35), (rear, y, z)), box((-x, -0.1, 0), (rear, 0.1, 0.35))]
    return Built(merge(parts), z, (Support(z, -x, -y, rear, y),))


def display(size: Size, _: Mapping[str, float]) -> Built:
    """A screen on a foot, facing the front."""
    x, y, z = size[0] / 2, size[1] / 2, size[2]
    parts = [
        box((-x, -y * 0.4, 0), (x, y * 0.4, 0.015)),
        box((-0.02, -0.03, 0.015), (0.0, 0.03, 0.12)),
        box((0.0, -y, 0.08), (0.03, y, z)),
    ]
    return Built(merge(parts), z)
