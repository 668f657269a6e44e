"""Where a home's views were truly taken, in the frame of a map: of a home with its truth."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from afkb.flow import View
from afkb.plugins.host import PluginHost
from afkb_mapping.geometry import T_from_xy_yaw, inverse
from bench.detectors.seen import placed_views

Truth = Mapping[str, Any]


def truth_of(home: Path) -> dict[str, Any]:
    """What `truth.json` of a home says."""
    return dict(json.loads((home / "truth.json").read_text()))


def T_map_world(mapped: Truth) -> NDArray[np.float64]:
    """(4, 4) from the truth's frame to that of a map that begins at its first view."""
    first = mapped["views"][0]
    return inverse(T_from_xy_yaw(first["x"], first["y"], first["yaw"]))


def true_views(host: PluginHost, home: Path, mapped: Truth, stride: int = 1) -> list[View]:
    """Every N-th view of a home, placed where it was taken, in the frame of the map of another."""
    T = T_map_world(mapped)
    views = host.open_source(str(home / "bag")).views(stride=stride)
    placed = placed_views(views, truth_of(home))
    return [replace(v, T_map_base=T @ v.T_map_base) for v in placed if v.T_map_base is not None]
