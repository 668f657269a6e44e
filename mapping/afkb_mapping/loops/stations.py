"""What closing loops needs of each view, in the frame of the base that took it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from afkb.flow import Detection, View
from afkb_mapping.geometry import inverse, planar
from afkb_mapping.loops.landmarks import Landmarks, Recogniser
from afkb_mapping.placing.scan_surface import SurfacePoints
from afkb_mapping.placing.view_surface import surest_in_map

Array = NDArray[np.float64]


class SeenView(Protocol):
    """A placed view with what was detected in it, as a run remembers it."""

    @property
    def view(self) -> View:
        """The view, with `T_map_base`."""
        ...

    @property
    def detections(self) -> Sequence[Detection]:
        """What was detected in it, in the map frame."""
        ...


@dataclass(frozen=True, slots=True, eq=False)
class Station:
    """One stop of the robot: where it was thought to be, and what it saw from there.

    - `index`, `stamp`: of the view. `T_odom_base`, `T_map_base`: 4x4, planar, by odometry and as
      registration placed it; `T_placed`: the latter with its height, roll and pitch.
    - `surface`: what stands upright, base frame; of the laser (`has_laser`), else of depth.
      `eye_xy`: (2,) m, base frame, where it was seen from.
    - `landmarks`: static things, base frame. `pose_is_given`: it is no odometry, and exact.
    """

    index: int
    stamp: float
    T_odom_base: Array
    T_map_base: Array
    T_placed: Array
    surface: SurfacePoints
    has_laser: bool
    eye_xy: Array
    landmarks: Landmarks
    pose_is_given: bool = False


def station_of(seen: SeenView, recogniser: Recogniser) -> Station:
    """The station of a placed view."""
    view = seen.view
    assert view.T_map_base is not None
    surface, by_laser = surest_in_map(view, view.T_map_base)
    back = inverse(planar(view.T_map_base))
    return Station(
        view.index,
        view.stamp,
        planar(view.T_odom_base),
        planar(view.T_map_base),
        view.T_map_base,
        surface.moved(back[:2, :2], back[:2, 3]),
        by_laser,
        _eye_of(view, by_laser),
        recogniser.landmarks_of(view, seen.detections),
        not view.has_base and view.scan is None,
    )


def _eye_of(view: View, by_laser: bool) -> Array:
    """(2,) where a view was seen from, base frame, m."""
    T = view.T_base_laser if by_laser else view.T_base_camera
    return np.zeros(2) if T is None else T[:2, 3].copy()
