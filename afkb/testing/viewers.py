"""The contract of a viewer."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from afkb.flow import Detection, View
from afkb.plugins.protocols import Viewer
from afkb.testing.require import require, require_name
from afkb.testing.sample_flow import sample_detections, sample_map


def check_viewer(
    viewer: Viewer,
    views: Sequence[View],
    detections: Sequence[Detection] | None = None,
    target: str | None = None,
) -> None:
    """Raise unless the viewer bears a whole run and leaves what it is shown as it is.

    `views`: placed ones; each is shown with the `detections` (by default a small sample) and with
    none. `target`: what it is begun with.
    """
    name = require_name(viewer, f"viewer {type(viewer).__name__}")
    who = f"viewer {name!r}"
    require(isinstance(viewer, Viewer), who, "is no Viewer", "see afkb.plugins.protocols")
    viewer.begin("sample", target)
    shown = sample_detections() if detections is None else detections
    for view in views:
        before = None if view.depth_m is None else view.depth_m.copy()
        for some in (shown, ()):
            viewer.show(view, some)
        kept = before is None or np.array_equal(before, np.asarray(view.depth_m))
        require(kept, who, "changes the depth image", "work on a copy")
    viewer.end(sample_map())
