"""Contain-ability grounded in depth: things on supports that are hollow or closed bodies."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import chain

import numpy as np
from numpy.typing import NDArray

from afkb.flow import Detection, View
from afkb_containers.above import Supports, fit_supports, label_things, map_points
from afkb_containers.clusters import Cluster, clusters_from_above, surroundings
from afkb_containers.concavity import Opening, find_opening
from afkb_containers.hidden import things_on_hidden_supports
from afkb_containers.settings import ContainerSettings
from afkb_containers.solid import Solid, sides_from_above, solid_of
from afkb_surfaces.describe import box_around, on_grid
from afkb_surfaces.settings import membership

ATTACHED = (0.08, 0.22)
"""Share of a thing's outline beyond which its surface goes on: below the first it stands free,
above the second it is part of something larger."""
LEAST_CLAIM = 0.1
CUT = 0.5
"""A body that the image edge cuts shows neither its top nor its thickness."""
SOLID, FLOATING = 0.75, 0.60
"""How often a closed, compact, upright body holds something: on a support seen, or not seen."""
SIGHT_SHARE = 0.6
"""Share of what a sight line could show of an opening, from which it is taken for deep."""


class ContainerDetector:
    """Finds open and closed containers; uses the supports that an earlier detector found."""

    name = "containers"
    affordances = ("ContainAbility", "IntrinsicContainAbility")
    stage = 1

    def __init__(self, settings: ContainerSettings | None = None) -> None:
        self.settings = settings or ContainerSettings()

    def detect(self, view: View, earlier: Sequence[Detection]) -> list[Detection]:
        """Containers in the map frame; none where the view has no depth."""
        if view.depth_m is None or view.camera is None:
            return []
        camera, T, s = view.camera, view.T_map_camera, self.settings
        intrinsics = np.array([camera.fx, camera.fy, camera.cx, camera.cy])
        points = map_points(view.depth_m, intrinsics, T)
        supports = Supports.of(earlier)
        planes = fit_supports(
            view.depth_m, points, supports.heights_m, supports.raster, supports.origin_xy
        )
        labels, overs = label_things(
            view.depth_m, points, planes, supports.large, supports.raster,
            supports.origin_xy, height_per_depth(intrinsics, T), *s.above_m,
        )
        found = []
        mine = np.zeros(view.depth_m.shape, np.int32)
        on_supports = self._things(view.depth_m, points, labels, overs, supports)
        hidden = things_on_hidden_supports(view.depth_m, points, labels, s.min_pixels)
        for name, cluster in enumerate(chain(on_supports, hidden), start=1):
            detection = self._judge(cluster, view.depth_m, labels, overs, mine, name, T[:3, 3])
            if detection is not None:
                found.append(detection)
        return found

    def _things(
        self,
        depth_m: NDArray[np.float32],
        points: NDArray[np.float32],
        labels: NDArray[np.int16],
        overs: NDArray[np.float32],
        supports: Supports,
    ) -> Iterator[Cluster]:
        flat = np.flatnonzero(labels.ravel() > 0)
        of = labels.ravel()[flat]
        order = np.argsort(of, kind="stable")
        flat = flat[order]
        starts = np.searchsorted(of[order], np.arange(1, len(supports.heights_m) + 2))
        for k, (begin, end) in enumerate(zip(starts[:-1], starts[1:], strict=True)):
            if end - begin >= self.settings.min_pixels:
                yield from clusters_from_above(
                    flat[begin:end], depth_m, points, overs, float(supports.heights_m[k]),
                    self.settings.core_m, self.settings.cell_m, self.settings.min_pixels,
                )

    def _judge(
        self,
        cluster: Cluster,
        depth_m: NDArray[np.float32],
        labels: NDArray[np.int16],
        overs: NDArray[np.float32],
        mine: NDArray[np.int32],
        name: int,
        camera_xyz: NDArray[np.float64],
    ) -> Detection | None:
        seen = cluster.support_height_m is not None
        base = lowest_seen(cluster) if cluster.support_height_m is None else cluster.support_height_m
        size = membership(sides_from_above(cluster)[0], self.settings.size_m)
        if size <= 0:
            return None
        mine[cluster.v, cluster.u] = name
        attached, *_ = surroundings(
            cluster.u, cluster.v, depth_m, mine, name, labels, overs, self.settings.core_m,
        )
        free = (ATTACHED[1] - attached) / (ATTACHED[1] - ATTACHED[0])
        if free <= 0:
            return None
        size *= min(1.0, free)
        solid = solid_of(cluster, base, self.settings)
        if solid.height_m > self.settings.above_m[1] - 0.02:
            return None
        opening = find_opening(cluster, camera_xyz)
        open_p = self._open_probability(opening) * size * solid.whole
        closed_p = (SOLID if seen else FLOATING) * solid.degree * size * (1 - open_p)
        if cluster.cut_by_image:
            closed_p *= CUT
        if max(open_p, closed_p) < LEAST_CLAIM:
            return None
        return self._detection(cluster, base, opening, solid, open_p, closed_p, attached)

    def _open_probability(self, opening: Opening | None) -> float:
        if opening is None or opening.rim_share < 0.5:
            return 0.0
        deep = membership(opening.depth_m, self.settings.depth_m)
        if opening.sight_share >= SIGHT_SHARE:
            deep = max(deep, 0.9)
        around = min(1.0, (opening.rim_share - 0.5) / 0.3)
        seen = min(1.0, opening.inside_share / 0.15)
        return 0.95 * deep * (0.3 + 0.7 * around) * (0.3 + 0.7 * seen)

    def _detection(
        self,
        cluster: Cluster,
        base_m: float,
        opening: Opening | None,
        solid: Solid,
        open_p: float,
        closed_p: float,
        attached: float,
    ) -> Detection:
        rim = opening.rim_height_m if opening else base_m + solid.height_m
        footprint = on_grid(cluster.points[:, :2], 0.02)
        box = box_around(on_grid(cluster.points[:, :2], 0.005), rim, 0.0, rim - base_m)
        affordances = {"ContainAbility": max(open_p, closed_p)}
        if closed_p >= LEAST_CLAIM:
            affordances["IntrinsicContainAbility"] = closed_p
        measures = {
            "rim_height": rim, "height": rim - base_m, "thickness": solid.thickness_m,
            "solidity": solid.solidity, "attached": attached,
        }  # fmt: skip
        if cluster.support_height_m is not None:
            measures["support_height"] = cluster.support_height_m
        if opening is not None:
            measures |= {
                "depth": opening.depth_m,
                "rim_share": opening.rim_share,
                "sight_share": opening.sight_share,
                "inside_share": opening.inside_share,
                "n_inside": float(opening.n_inside),
            }
        spread = cluster.sigma_m**2 + 1e-4
        return Detection(
            detector=self.name,
            affordances=affordances,
            box=box,
            position_xyz=np.array(box.center_xyz),
            covariance_xyz=np.diag([spread, spread, 0.25 * spread]),
            footprint_xy=footprint,
            n_pixels=len(cluster.u),
            range_m=float(np.percentile(cluster.depth_m, 1)),
            image_box=cluster.image_box,
            cut_by_image=cluster.cut_by_image,
            measures=measures,
        )


def lowest_seen(cluster: Cluster) -> float:
    """Height of the lowest part of a thing in sight, strays left out, m."""
    return float(np.percentile(cluster.points[:, 2], 2))


def height_per_depth(
    intrinsics: NDArray[np.float64], T_map_camera: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Coefficients (3,) of (u, v, 1) that give a pixel's change of height per metre of depth."""
    fx, fy, cx, cy = intrinsics
    a, b, c = T_map_camera[2, :3]
    return np.array([a / fx, b / fy, c - a * cx / fx - b * cy / fy])
