"""Rooms of buildings' plans, empty, furnished and with trash bins, against those people drew."""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from afkb.flow import OccupancyGrid
from afkb_mapping.rooms.rooms import segment_rooms
from bench.detectors.data import NoData, data_folder
from bench.floor_plans import FREE_FROM, RESOLUTION_M, TRUTH, read_plan
from bench.mapping.room_jitter import steadiness
from bench.mapping.room_peers import morphological, voronoi, watershed
from bench.mapping.room_scores import MEASURES, Labels, Scores, regions, scores

Mask = NDArray[np.bool_]
Segmenter = Callable[[Mask, float], Labels]

VARIANTS = {
    "empty": "",
    "furnished": "_furnitures",
    "trash bins": "_trashbins",
    "furnished, trash bins": "_furnitures_trashbins",
}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Where the plans are: pairs `NAME.png`, `NAME_gt_segmentation.png`, variants beside them."""
    parser.add_argument("--folder", type=Path, default=data_folder() / "floorplans")
    parser.add_argument("--resolution", type=float, default=RESOLUTION_M, help="m a pixel")
    parser.add_argument("--only", nargs="+", default=[], metavar="NAME", help="these plans")
    parser.add_argument("--no-peers", action="store_true", help="ours alone")
    parser.add_argument("--jitter", action="store_true", help="how steady rooms are, instead")


def run(args: argparse.Namespace) -> dict[str, dict[str, dict[str, Scores]]]:
    """By method and variant, by plan: the scores and CPU seconds."""
    truths = sorted(args.folder.glob("*" + TRUTH)) if args.folder.is_dir() else []
    names = [t.name.removesuffix(TRUTH) for t in truths]
    names = [n for n in names if not args.only or n in args.only]
    if not names:
        raise NoData(f"no NAME{TRUTH} in {args.folder}; name a folder with --folder")
    methods = {"afkb": afkb} if args.no_peers else METHODS
    measured = steady if args.jitter else scored
    return {
        method: {
            variant: {
                name: measured(segmenter, args.folder, name, suffix, args.resolution)
                for name in names
                if (args.folder / f"{name}{suffix}.png").is_file()
            }
            for variant, suffix in VARIANTS.items()
        }
        for method, segmenter in methods.items()
    }


def afkb(free: Mask, resolution_m: float) -> Labels:
    """The rooms that a map of this grid has."""
    probability = np.where(free, 0.0, 1.0).astype(np.float32)
    return segment_rooms(OccupancyGrid(probability, resolution_m, (0.0, 0.0))).labels


METHODS: dict[str, Segmenter] = {
    "afkb": afkb,
    "distance-transform watershed": watershed,
    "morphological": morphological,
    "Voronoi": voronoi,
}


def steady(
    segmenter: Segmenter, folder: Path, name: str, suffix: str, resolution_m: float
) -> Scores:
    """How steady one plan's rooms are, by drawing."""
    free = read_plan(folder / f"{name}{suffix}.png") >= FREE_FROM
    return steadiness(segmenter, free, resolution_m)


def scored(
    segmenter: Segmenter, folder: Path, name: str, suffix: str, resolution_m: float
) -> Scores:
    """One plan's scores; `seconds` of CPU time."""
    free = read_plan(folder / f"{name}{suffix}.png") >= FREE_FROM
    true = regions(read_plan(folder / (name + TRUTH)) > FREE_FROM)
    start = time.thread_time()
    found = segmenter(free, resolution_m)
    seconds = time.thread_time() - start
    return {**scores(found, true), "seconds": seconds}


def table(result: dict[str, dict[str, dict[str, Any]]]) -> Iterator[str]:
    """Ours plan by plan; of each method the means over the plans."""
    if "mcc" not in next(iter(result["afkb"]["empty"].values())):
        yield from steady_table(result)
        return
    for variant, plans in result["afkb"].items():
        yield HEAD.format(variant)
        for name, s in plans.items():
            yield said(name, [s])
    yield ""
    yield HEAD.format("mean over the plans")
    for method, variants in result.items():
        for variant, plans in variants.items():
            if plans:
                yield said(f"{method}, {variant}", list(plans.values()))


HEAD = "{:52} precision recall   MCC  of cells  rooms of     s"


def said(name: str, of: Sequence[Scores]) -> str:
    """One line: means of the measures, sums of the numbers."""
    p, r, mcc, cells = (float(np.mean([s[m] for s in of])) for m in MEASURES)
    found, true = (round(sum(s[k] for s in of)) for k in ("segments", "rooms"))
    seconds = max(s["seconds"] for s in of)
    numbers = f"{found:6d} {true:2d} {seconds:5.2f}"
    return f"{name:52} {p:9.3f} {r:6.3f} {mcc:5.3f} {cells:9.3f} {numbers}"


def steady_table(result: dict[str, dict[str, dict[str, Any]]]) -> Iterator[str]:
    """Of each method and variant, mean and least over the plans by drawing."""
    yield "rooms of the plan drawn another way, MCC with those of the plan: mean, least"
    for method, variants in result.items():
        for variant, plans in variants.items():
            if not plans:
                continue
            yield f"{method}, {variant}"
            of = list(plans.values())
            for drawing in of[0]:
                values = [plan[drawing] for plan in of]
                yield f"  {drawing:24} {np.mean(values):.3f} {min(values):.3f}"
            values = [v for plan in of for v in plan.values()]
            yield f"  {'all':24} {np.mean(values):.3f} {min(values):.3f}"
