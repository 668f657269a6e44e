"""A hall of chairs as a simulated world, and the same hall after all its chairs were shoved aside.

Rows of chairs stand either side of an aisle, tables among them, walls further off. Later all chairs
stand elsewhere by one vector, as they do after a floor was swept, or each by one of its own.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import yaml

Thing = dict[str, Any]

LENGTH_M, WIDTH_M = 14.0, 12.0
ROWS_M, SEATS_M = 0.95, 0.65
"""From row to row, and from seat to seat of a row."""
AISLE_M = 1.3
"""From the middle of the aisle to the first seats."""
SEATS_A_ROW = 3
JITTER_M, JITTER_DEG = 0.05, 8.0
ABSENT = 0.15
"""Share of the seats that have no chair."""
TABLES = (3, 8)
TABLE_M = (0.8, 1.2, 0.75)
CLEAR_M = 1.25
"""No chair is as near to the middle of a table: however chairs are shoved, none gets into one."""
SHOVED_M = (0.3, 0.5)
LOOKS_DEG = [0, 45, -45]


def hall(rng: np.random.Generator) -> dict[str, Any]:
    """A world, as its file says it; which seats are taken and where tables stand is drawn."""
    xs = np.arange(2.5, LENGTH_M - 2.0, ROWS_M)
    ys = [s * (AISLE_M + i * SEATS_M) for s in (-1, 1) for i in range(SEATS_A_ROW)]
    middle = AISLE_M + SEATS_M * (SEATS_A_ROW - 1) / 2
    tables = np.array(
        [
            (rng.choice(xs), WIDTH_M / 2 + rng.choice([-1, 1]) * (middle + rng.uniform(0, 0.5)))
            for _ in range(rng.integers(*TABLES))
        ]
    )
    things: list[Thing] = []
    for x, y in np.unique(tables, axis=0).tolist():
        things.append(_thing("table", "DiningTable", len(things), x, y, 90.0, size=list(TABLE_M)))
    for x in xs:
        for y in ys:
            at = np.array([x, WIDTH_M / 2 + y]) + rng.normal(0, JITTER_M, 2)
            yaw = float(180 + rng.normal(0, JITTER_DEG))
            if rng.random() > ABSENT and np.hypot(*(tables - at).T).min() >= CLEAR_M:
                things.append(_thing("chair", "DiningChair", len(things), *at.tolist(), yaw))
    return {
        "name": "hall",
        "rooms": [
            {"name": "hall", "category": "DiningRoom", "rectangle": [0.0, 0.0, LENGTH_M, WIDTH_M]}
        ],
        "things": things,
        "tour": {
            "waypoints": [
                {"name": f"aisle_{i}", "at": [x, WIDTH_M / 2], "yaw_deg": 0, "looks_deg": LOOKS_DEG}
                for i, x in enumerate(np.linspace(1.5, LENGTH_M - 2.5, 5).round(2).tolist())
            ]
        },
    }


def shoved(world: dict[str, Any], rng: np.random.Generator, together: bool) -> dict[str, Any]:
    """The same world with every chair elsewhere: all by one vector, or each by its own."""
    by = _vector(rng)
    things = []
    for thing in world["things"]:
        if thing["shape"] == "chair":
            step = by if together else _vector(rng)
            thing = {**thing, "at": (np.array(thing["at"]) + step).round(3).tolist()}
        things.append(thing)
    return {**world, "seed": int(rng.integers(1 << 16)), "things": things}


def written(world: dict[str, Any], path: Path) -> Path:
    """Write a world file, and return its path."""
    path.write_text(yaml.safe_dump(world), encoding="utf-8")
    return path


def _vector(rng: np.random.Generator) -> np.ndarray[Any, np.dtype[np.float64]]:
    far, angle = rng.uniform(*SHOVED_M), rng.uniform(0, math.tau)
    return far * np.array([math.cos(angle), math.sin(angle)])


def _thing(
    shape: str, category: str, number: int, x: float, y: float, yaw_deg: float, **more: Any
) -> Thing:
    at = [round(x, 3), round(y, 3)]
    name = f"{shape}_{number}"
    return {
        "name": name,
        "shape": shape,
        "category": category,
        "at": at,
        "yaw_deg": round(yaw_deg, 1),
        **more,
    }
