"""A made-up map with as many things as is asked for."""

from __future__ import annotations

import numpy as np

from afkb.flow import (
    Change,
    ChangeKind,
    Entity,
    NodeKind,
    OccupancyGrid,
    RobotPlace,
    TopologicalMap,
)

_PER_SQUARE_METRE = 1.25
_SECONDS = 300
_CELL_M = 0.1


def large_map(nodes: int, seed: int = 0) -> TopologicalMap:
    """Tables and mugs, strewn over a floor; seen one after the other; the same for a seed."""
    rng = np.random.default_rng(seed)
    side = float(np.sqrt(nodes / _PER_SQUARE_METRE))
    where = rng.uniform(0, side, (nodes, 2))
    cells = int(side / _CELL_M)
    grid = OccupancyGrid(rng.random((cells, cells), dtype=np.float32), _CELL_M, (0.0, 0.0))
    way = np.zeros((_SECONDS, 17))
    way[:, 0] = np.arange(_SECONDS)
    way[:, 4] = way[:, 8] = np.linspace(0, side, _SECONDS)
    return TopologicalMap(
        places=(RobotPlace("place-1", 0.0, 0.0, 0.0, 0.0, 0),),
        entities=tuple(_thing(i, float(x), float(y)) for i, (x, y) in enumerate(where)),
        bounds=(),
        doorways=(),
        rooms=(),
        edges=(),
        grid=grid,
        T_map_source=np.eye(4),
        trajectory=way,
    )


def _thing(number: int, x: float, y: float) -> Entity:
    large = number % 3 == 0
    stamp = float(number % _SECONDS)
    return Entity(
        id=f"thing-{number}",
        kind=NodeKind.OBSERVED if number % 5 else NodeKind.DUAL,
        position_xyz=(x, y, 0.75),
        size_xyz=(0.8, 0.6, 0.05) if large else (0.09, 0.08, 0.1),
        yaw=float(number),
        affordances={"SupportAbility" if large else "ContainAbility": 0.9},
        existence=0.9,
        category_belief={"Table" if large else "Mug": 0.8},
        movability="Static" if large else "Dynamic",
        matching_weight=1.0,
        observations=3,
        first_seen=stamp,
        last_seen=stamp,
        seen_from=("place-1",),
        generated_by=("surfaces",),
        history=(Change(ChangeKind.SIGHTED, 0.9, None, 0.9, stamp, number),),
    )
