"""Rooms of homes as vacuum robots map them, against the segments that their owners see."""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from afkb.flow import OccupancyGrid
from afkb_mapping.rooms.rooms import segment_rooms
from bench.detectors.data import NoData, data_folder
from bench.mapping.floorplans import HEAD, METHODS, said
from bench.mapping.room_scores import Labels, Scores, scores

CM_BELOW = 10
"""`pixelSize` is in cm, in older files in mm; pixels are five centimetres, or less."""
FREE, OCCUPIED = 0.1, 0.9
MARGIN = 2


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Where the maps are: JSON files of the class `ValetudoMap`."""
    parser.add_argument("--folder", type=Path, default=data_folder() / "vacuum")
    parser.add_argument("--no-peers", action="store_true", help="ours alone")


def run(args: argparse.Namespace) -> dict[str, dict[str, Scores]]:
    """By method, by map: the scores and CPU seconds."""
    files = sorted(args.folder.glob("*.json")) if args.folder.is_dir() else []
    if not files:
        raise NoData(f"no map (*.json) in {args.folder}; name a folder with --folder")
    maps = {file.stem: read_map(file) for file in files}
    peers = () if args.no_peers else tuple(name for name in METHODS if name != "afkb")
    return {
        method: {name: _scored(method, *of_map) for name, of_map in maps.items()}
        for method in ("afkb", *peers)
    }


def read_map(path: Path) -> tuple[OccupancyGrid, Labels]:
    """The grid of a map, and the segment of each cell, 0 = none; raises `NoData` for another file.

    Cells of floor and segments are free, of walls occupied, all others unknown.
    """
    content = json.loads(path.read_text())
    if not isinstance(content, dict) or content.get("__class") != "ValetudoMap":
        raise NoData(f"{path}: no ValetudoMap")
    layers = [(layer["type"], _cells(layer)) for layer in content["layers"]]
    everything = np.concatenate([cells for _, cells in layers])
    low = everything.min(axis=0) - MARGIN
    cols, rows = everything.max(axis=0) + MARGIN + 1 - low
    probability = np.full((rows, cols), np.nan, dtype=np.float32)
    segments = np.zeros((rows, cols), dtype=np.int32)
    for number, (kind, cells) in enumerate(layers, start=1):
        at = tuple((cells - low)[:, ::-1].T)
        probability[at] = OCCUPIED if kind == "wall" else FREE
        if kind == "segment":
            segments[at] = number
    size = float(content["pixelSize"])
    return OccupancyGrid(
        probability, size / (100 if size < CM_BELOW else 1000), (0.0, 0.0)
    ), segments


def _cells(layer: dict[str, Any]) -> NDArray[np.int64]:
    """(N, 2) x and y of a layer's pixels; compressed, a run is its first pixel and its length."""
    runs = np.array(layer.get("compressedPixels") or [], dtype=np.int64).reshape(-1, 3)
    along = np.concatenate([np.arange(n) for n in runs[:, 2]] or [np.zeros(0, np.int64)])
    spread = np.repeat(runs[:, :2], runs[:, 2], axis=0) + np.column_stack([along, 0 * along])
    plain = np.array(layer.get("pixels") or [], dtype=np.int64).reshape(-1, 2)
    return np.concatenate([plain, spread])


def _scored(method: str, grid: OccupancyGrid, segments: Labels) -> Scores:
    start = time.thread_time()
    if method == "afkb":
        found = segment_rooms(grid).labels
    else:
        found = METHODS[method](grid.probability < 0.5, grid.resolution_m)
    seconds = time.thread_time() - start
    return {**scores(found, segments), "seconds": seconds}


def table(result: dict[str, dict[str, Scores]]) -> Iterator[str]:
    """Ours map by map; of each method the means over the maps."""
    yield HEAD.format("")
    for name, s in result["afkb"].items():
        yield said(name, [s])
    for method, maps in result.items():
        of: Sequence[Scores] = list(maps.values())
        yield said(f"{method}, mean over the maps", of)
