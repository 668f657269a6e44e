"""Labels of real table-tops: which object each pixel is of."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from afkb.flow import Detection
from bench.detectors.mosd import IOU
from bench.detectors.mosd_clouds import Cloud

BUILDING = "mosd"
CLOSED_GROUPS = ("box", "stacked")
"""Clouds in which every object is a closed package."""
MOSTLY = 0.8
LABELLED = 0.5
"""Of less than this share of a claim that has a label, nothing is told."""
CLOSED = ("ContainAbility", "IntrinsicContainAbility")


class CloudLabels:
    """Right if a body is one object; if a support lies on one; if what closes in is a package."""

    building = BUILDING

    def __init__(self, clouds: Sequence[Cloud]) -> None:
        self._clouds = {c.view.index: c for c in clouds}

    def scene(self, index: int, stamp: float) -> str:
        """The cloud."""
        return self._clouds[index].name

    def judge(
        self, claim: Detection, feature: str, index: int, thing: Detection
    ) -> tuple[bool, str] | None:
        """Whether the claim is so, and of which object."""
        cloud = self._clouds[index]
        shown = _labels_under(thing, cloud)
        labelled = shown[shown > 0]
        if claim.measures.get("is_floor") or len(labelled) <= LABELLED * max(len(shown), 1):
            return None
        best = int(np.bincount(labelled).argmax())
        name = f"{cloud.name} {best}"
        if feature == "SupportAbility" and "area" in thing.measures:
            return bool((labelled == best).mean() >= MOSTLY), name
        if thing.pixels is not None:
            whole = best > 1 and _overlap(cloud.objects, labelled, best) >= IOU
        else:
            whole = best > 1 and bool((labelled == best).mean() >= MOSTLY)
        told = feature == "DisposeAbility" or (feature in CLOSED and cloud.group in CLOSED_GROUPS)
        return (whole, name) if told else None


def _labels_under(claim: Detection, cloud: Cloud) -> NDArray[np.int32]:
    """Labels of its pixels; of those its footprint falls on where it keeps none."""
    if claim.pixels is not None:
        return cloud.objects.ravel()[claim.pixels]
    camera = cloud.view.camera
    assert camera is not None
    flat = np.full((len(claim.footprint_xy), 1), claim.box.top)
    T = np.linalg.inv(cloud.view.T_map_camera)
    p = np.hstack([claim.footprint_xy, flat]) @ T[:3, :3].T + T[:3, 3]
    p = p[p[:, 2] > 0]
    u = np.rint(camera.fx * p[:, 0] / p[:, 2] + camera.cx).astype(int)
    v = np.rint(camera.fy * p[:, 1] / p[:, 2] + camera.cy).astype(int)
    within = (u >= 0) & (v >= 0) & (u < camera.width) & (v < camera.height)
    return cloud.objects[v[within], u[within]]


def _overlap(objects: NDArray[np.int32], labelled: NDArray[np.int32], best: int) -> float:
    both = int((labelled == best).sum())
    return both / (int((objects == best).sum()) + len(labelled) - both)
