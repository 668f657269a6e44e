"""A whole map read back from its folder, for what needs it as it was when it was made."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from afkb.errors import MapError
from afkb.flow import TopologicalMap
from afkb.store import StoredMap
from afkb.store.reading import read_graph
from afkb.store.stored import RUN_FILE
from afkb.store.stored_grid import read_grid

TRAJECTORY_FILE = Path("state", "trajectory.txt")


def read_map(stored: StoredMap) -> TopologicalMap:
    """The map of a folder: its graph from the RDF, grid and trajectory from the files beside it.

    See `afkb.store.reading` for what the RDF does not hold; grid cells come back to 1/255.
    Raises `MapError` where the grid is missing or anything can't be read.
    """
    graph = read_graph(stored)
    run = run_of(stored.folder)
    T = np.array(run.get("T_map_source", np.eye(4)), dtype=np.float64)
    return TopologicalMap(
        places=graph.places,
        entities=graph.entities,
        bounds=graph.bounds,
        doorways=graph.doorways,
        rooms=graph.rooms,
        edges=graph.edges,
        grid=read_grid(stored.folder).grid,
        T_map_source=T,
        trajectory=_trajectory(stored.folder),
        closures=graph.closures,
        past_predictions=graph.past_predictions,
        notes=tuple(stored.notes),
        counts=stored.counts,
    )


def run_of(folder: Path) -> dict[str, Any]:
    """What run.json of a map holds; nothing where there is none that can be read."""
    try:
        told = json.loads((folder / RUN_FILE).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        # A map without a readable run.json is still a map; how it was made is then unknown.
        return {}
    return told if isinstance(told, dict) else {}


def _trajectory(folder: Path) -> NDArray[np.float64]:
    """(N, 17): stamp and T_map_base, a row a view; none where the map has no trajectory."""
    path = folder / TRAJECTORY_FILE
    if not path.is_file():
        return np.empty((0, 17))
    try:
        return np.loadtxt(path, ndmin=2).reshape(-1, 17)
    except ValueError as error:
        raise MapError(f"{path}: not readable as poses ({error}); map again") from error
