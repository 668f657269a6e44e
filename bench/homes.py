"""How well a map of a recorded home agrees with its truth.

    python -m bench.homes MAP --truth truth.json [--json]

Prints: error of every view's position (m), supports that were seen well against the nodes of the
map, small things by kind, and doorways where there is a list of them. Truth has the form of
`homes/*/truth.json`: world frame, z up, the first view's pose is the map's origin.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections import Counter
from pathlib import Path

import numpy as np

from afkb_mapping.geometry import T_from_xy_yaw, yaw_of
from bench.doorway_labels import list_for, said, scored

WELL_SEEN_TOP_PIXELS = 3000
WELL_SEEN_PIXELS = 600
WITHIN_M = 0.15
HEIGHT_WITHIN_M = 0.05
HOLLOW = {"mug", "cup", "bowl", "pitcher", "pot", "pan", "plate", "basket", "bathtub", "sink"}
NO_SUPPORT = {"carpet", "floor_lamp", "picture", "mirror", "window", "door", "curtain", "plant"}
RUNS = {"bottom_cabinet", "bottom_cabinet_no_top", "counter", "dishwasher", "oven", "cooktop"}
"""A run of these is one counter: the node has to cover the thing, not to share its centre."""
BESIDE_M = 0.05


def nodes_of(folder: Path) -> list[dict]:
    """Observed nodes of a map folder, with their positions in the map frame."""
    content = json.loads((folder / "map.json").read_text())
    return [n for n in _walk(content) if n.get("kind") == "ObservedEntity"]


def _walk(content: object):
    if isinstance(content, dict):
        if "kind" in content and "id" in content:
            yield content
        for value in content.values():
            yield from _walk(value)
    elif isinstance(content, list):
        for value in content:
            yield from _walk(value)


def in_world(nodes: list[dict], T_world_map: np.ndarray) -> list[dict]:
    moved = []
    for node in nodes:
        x, y, *_ = T_world_map @ [node["x"], node["y"], 0, 1]
        moved.append({**node, "x": x, "y": y, "yaw": node["yaw"] + yaw_of(T_world_map)})
    return moved


def trajectory_errors(folder: Path, truth: dict, T_world_map: np.ndarray) -> np.ndarray:
    """Distance of each mapped view from its true position, m."""
    rows = np.loadtxt(folder / "state" / "trajectory.txt", ndmin=2)
    true = {round(v["stamp"], 3): (v["x"], v["y"]) for v in truth["views"]}
    errors = []
    for row in rows:
        T = T_world_map @ row[1:].reshape(4, 4)
        if round(row[0], 3) in true:
            errors.append(np.hypot(*(T[:2, 3] - true[round(row[0], 3)])))
    return np.array(errors)


def _inside(node: dict, thing: dict, slack: float = BESIDE_M) -> bool:
    return all(
        thing["min"][i] - slack <= node[a] <= thing["max"][i] + slack for i, a in enumerate("xyz")
    )


def _distance(node: dict, center: np.ndarray, run: bool) -> float:
    """From the node's centre to the thing's, or from its rectangle where it is one of a run, m."""
    offset = center - [node["x"], node["y"]]
    if not run:
        return float(np.hypot(*offset))
    c, s = np.cos(node["yaw"]), np.sin(node["yaw"])
    along = np.abs([c * offset[0] + s * offset[1], -s * offset[0] + c * offset[1]])
    return float(np.hypot(*np.maximum(along - np.array(node["size"][:2]) / 2, 0)))


def supports(nodes: list[dict], truth: dict) -> list[dict]:
    """One row per well-seen support: how many nodes lie on its top, and how far off the best is."""
    rows = []
    surfaces = [n for n in nodes if "SupportAbility" in n["affords"] and n["z"] > 0.08]
    for thing in truth["things"]:
        if thing["top_pixels"] < WELL_SEEN_TOP_PIXELS or thing["category"] in NO_SUPPORT:
            continue
        center = (np.array(thing["min"][:2]) + thing["max"][:2]) / 2
        on_top = [
            n
            for n in surfaces
            if abs(n["z"] - thing["top_height"]) < HEIGHT_WITHIN_M
            and (_inside(n, thing) or _distance(n, center, thing["category"] in RUNS) < WITHIN_M)
        ]
        run = thing["category"] in RUNS
        errors = [_distance(n, center, run) for n in on_top]
        rows.append(
            {
                "thing": thing["name"],
                "top_height": thing["top_height"],
                "top_pixels": thing["top_pixels"],
                "size": [round(b - a, 2) for a, b in zip(thing["min"], thing["max"], strict=True)],
                "nodes": [n["id"] for n in on_top],
                "error_m": round(min(errors), 3) if errors else None,
                "height_error_m": round(min(abs(n["z"] - thing["top_height"]) for n in on_top), 4)
                if on_top
                else None,
            }
        )
    return rows


def precision(nodes: list[dict], truth: dict) -> dict:
    """Share of surface nodes that lie in some thing's box, and those that do not."""
    surfaces = [n for n in nodes if "SupportAbility" in n["affords"] and n["z"] > 0.08]
    stray = [n for n in surfaces if not any(_inside(n, t, 0.08) for t in truth["things"])]
    return {
        "surfaces": len(surfaces),
        "stray": [(n["id"], round(n["x"], 2), round(n["y"], 2), round(n["z"], 2)) for n in stray],
    }


def small_things(nodes: list[dict], truth: dict) -> dict:
    """Containers against the small things that were seen well."""
    containers = [n for n in nodes if "ContainAbility" in n["affords"]]
    small = [t for t in truth["things"] if t["on"] and t["most_pixels"] >= WELL_SEEN_PIXELS]
    found = {t["name"]: [n["id"] for n in containers if _inside(n, t, 0.04)] for t in small}
    kinds = Counter(t["category"] for t in small)
    hit = Counter(t["category"] for t in small if found[t["name"]])
    stray = [n for n in containers if not any(_inside(n, t, 0.08) for t in truth["things"])]
    return {
        "by_category": {k: f"{hit[k]}/{n}" for k, n in sorted(kinds.items())},
        "doubled": {k: v for k, v in found.items() if len(v) > 1},
        "containers": len(containers),
        "in_no_box": len(stray),
    }


def doorways(folder: Path, listed: list[dict] | None, T_world_map: np.ndarray) -> dict | None:
    """Doorways of the map against the list made by eye; None where there is no list."""
    if listed is None:
        return None
    return scored(
        listed, in_world(json.loads((folder / "map.json").read_text())["doorways"], T_world_map)
    )


def evaluate(folder: Path, truth: dict, listed: list[dict] | None = None) -> dict:
    first = truth["views"][0]
    T_world_map = T_from_xy_yaw(first["x"], first["y"], first["yaw"])
    nodes = in_world(nodes_of(folder), T_world_map)
    errors = trajectory_errors(folder, truth, T_world_map)
    rows = supports(nodes, truth)
    found = [r for r in rows if r["error_m"] is not None and r["error_m"] <= WITHIN_M]
    return {
        "position_error_m": {
            "mean": round(float(errors.mean()), 4),
            "greatest": round(float(errors.max()), 4),
        },
        "supports_found": f"{len(found)}/{len(rows)}",
        "supports_single": f"{sum(len(r['nodes']) == 1 for r in rows)}/{len(rows)}",
        "supports": rows,
        "precision": precision(nodes, truth),
        "small_things": small_things(nodes, truth),
        "doorways": doorways(folder, listed, T_world_map),
    }


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("map", type=Path)
    parser.add_argument("--truth", type=Path, required=True)
    parser.add_argument("--json", action="store_true")
    arguments = parser.parse_args()
    truth = json.loads(arguments.truth.read_text())
    result = evaluate(arguments.map, truth, list_for(arguments.truth.resolve().parent))
    if arguments.json:
        json.dump(result, sys.stdout, indent=1)
        return 0
    for key, value in result.items():
        if key == "supports":
            continue  # Thing by thing is what --json is for.
        if key == "doorways":
            print(key, said(value) if value else "no list of them")
        else:
            print(key, value)
    return 0


if __name__ == "__main__":
    sys.exit(main())
