"""Static or dynamic, and how large, told from one frame: against what the homes' truth says.

A claim is a support or a container that one view shows and that lies in a thing of the truth.
Movable, in the truth, is what a person or the makers of the recording move; a wrong `Dynamic` takes
a landmark away, a wrong `Static` blocks a way that is free.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from typing import Any

import numpy as np

from afkb.flow import Detection
from afkb.inference import network_of
from afkb_mapping.frame_report import described
from afkb_mapping.one_per_thing import one_per_thing
from bench.detectors.data import Asked, Home
from bench.detectors.seen import CLAIMED, MARGIN_M

NEEDS = ("homes",)
CLAIMS = ("SupportAbility", "ContainAbility")


def run(asked: Asked) -> dict[str, Any]:
    """Per home: claims by what they are and what they were taken for; right ones beside a guess."""
    network = network_of(asked.host.knowledge_base)
    return {home.name: _score(home, network) for home in asked.homes}


def _score(home: Home, network: Any) -> dict[str, Any]:
    taken: Counter[tuple[str, str]] = Counter()
    sizes = 0
    for _, detections in home.seen.views:
        for detection in one_per_thing(detections):
            thing = _thing_of(detection, home.truth["things"])
            if thing is None:
                continue
            told = described(detection, network)
            truly = "Dynamic" if thing["movable"] else "Static"
            taken[truly, str(told["movability"])] += 1
            sizes += told["scale"] == network.knowledge_base.scale_of(_size(thing))
    total = sum(taken.values())
    right = sum(n for (truly, said), n in taken.items() if truly == said)
    static = sum(n for (truly, _), n in taken.items() if truly == "Static")
    return {
        "claims": total,
        "right": right / max(total, 1),
        "always_the_commoner": max(static, total - static) / max(total, 1),
        "static_found": taken["Static", "Static"] / max(static, 1),
        "dynamic_found": taken["Dynamic", "Dynamic"] / max(total - static, 1),
        "scale_right": sizes / max(total, 1),
    }


def _size(thing: dict[str, Any]) -> tuple[float, float, float]:
    x, y, z = (float(b - a) for a, b in zip(thing["min"], thing["max"], strict=True))
    return x, y, z


def _thing_of(detection: Detection, things: list[dict[str, Any]]) -> dict[str, Any] | None:
    """The smallest thing whose box holds what the detection claims; the floor is none."""
    if detection.segment_xy is not None or detection.measures.get("is_floor"):
        return None
    if not any(detection.affords(feature, CLAIMED) for feature in CLAIMS):
        return None
    at = np.asarray(detection.position_xyz)
    holding = [
        t
        for t in things
        if np.all(at >= np.array(t["min"]) - MARGIN_M)
        and np.all(at <= np.array(t["max"]) + MARGIN_M)
    ]
    return min(holding, key=lambda t: float(np.prod(_size(t))), default=None)


def table(result: dict[str, Any]) -> Iterator[str]:
    """A line a home."""
    for name, r in result.items():
        yield (
            f"{name:12} {r['claims']:4d} claims: static or dynamic right {r['right']:.2f} "
            f"(always the commoner {r['always_the_commoner']:.2f}), of the static "
            f"{r['static_found']:.2f}, of the dynamic {r['dynamic_found']:.2f}; "
            f"scale right {r['scale_right']:.2f}"
        )
