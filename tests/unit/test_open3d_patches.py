"""The second surface detector sees the same table, behind the same protocol."""

from __future__ import annotations

import numpy as np
import pytest

from afkb.plugins.host import PluginHost
from afkb_open3d_patches.detector import PlanarPatchDetector
from depth_samples import FLOOR, Box, table, view_of

WALL = Box((3.0, -5.0, 0.0), (3.2, 5.0, 2.6))


def test_it_finds_the_table_the_floor_and_the_wall() -> None:
    view = view_of([FLOOR, table(1.6, 0.1, 0.73), WALL], rng=np.random.default_rng(6))
    found = PlanarPatchDetector().detect(view)
    (floor,) = [d for d in found if d.measures.get("is_floor")]
    assert floor.position_xyz[2] == 0.0
    tops = [d for d in found if d.affords("SupportAbility") and d is not floor]
    assert [d.position_xyz[2] for d in tops] == [pytest.approx(0.73, abs=0.01)]
    assert tops[0].box.size_xyz[:2] == pytest.approx((1.2, 0.8), abs=0.17)
    assert any(d.segment_xy is not None for d in found)


def test_it_does_not_run_beside_ours_unless_it_is_named() -> None:
    host = PluginHost()
    assert "open3d-patches" not in [d.name for d in host.detectors()]
    names = [d.name for d in host.detectors(["open3d-patches", "containers"])]
    assert names == ["open3d-patches", "containers"]
