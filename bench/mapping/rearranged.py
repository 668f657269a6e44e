"""A simulated world at a later visit: what gets moved was moved, or has gone."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import yaml

from afkb.errors import AfkbError
from afkb.knowledge import AfNet
from afkb.plugins.host import PluginHost

GONE = 0.3
"""Share of the movable things that are taken away; the others are moved."""
MOVED_M = (0.3, 0.8)
TRIES = 8


def rearranged(world: Path, out: Path, kb: AfNet, seed: int) -> Path:
    """Write the world with its dynamic things elsewhere, and return its path.

    A thing that would stand in another's place, or in the robot's way, is put elsewhere again, and
    at last left where it was.
    """
    rng = np.random.default_rng(seed)
    content = yaml.safe_load(world.read_text(encoding="utf-8"))
    # To YAML 1.1 the key `on` is a truth value.
    content["things"] = [
        {k if k is not True else "on": v for k, v in t.items()} for t in content["things"]
    ]
    things: list[dict[str, Any]] = content["things"]
    for thing in [t for t in things if _moves(t, kb)]:
        if rng.random() < GONE:
            things.remove(thing)
        elif "on" not in thing:
            _move(thing, content, out, rng)
    out.write_text(yaml.safe_dump(content), encoding="utf-8")
    return out


def _moves(thing: dict[str, Any], kb: AfNet) -> bool:
    """Whether the ontology says so; of what it doesn't know, whether it stands on something."""
    category = kb.categories.get(thing["category"])
    return "on" in thing if category is None else category.movability == "Dynamic"


def _move(
    thing: dict[str, Any], content: dict[str, Any], out: Path, rng: np.random.Generator
) -> None:
    was = dict(thing)
    for _ in range(TRIES):
        angle, far = rng.uniform(0, 2 * np.pi), rng.uniform(*MOVED_M)
        step = far * np.array([np.cos(angle), np.sin(angle)])
        thing["at"] = [round(float(v), 3) for v in np.array(was["at"]) + step]
        thing["yaw_deg"] = float(round(rng.uniform(-180, 180)))
        out.write_text(yaml.safe_dump(content), encoding="utf-8")
        try:
            PluginHost().open_source(str(out), {})
        except AfkbError:
            continue
        return
    thing.clear()
    thing.update(was)
