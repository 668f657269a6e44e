"""The map of the paper's simulated home (Fig. 2) beside the truth of that home.

    python -m bench.paper_home [--out MAP] [--mapper affordance] [--json]

Prints the paper's figures and ours. The map is made without the truth; only this comparison reads
it: error of the robot's position (m; at the return to the kitchen, where the loop closes, apart),
the hidden table's place (m), rooms by their category, and whether what was taken away is gone.
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
from pathlib import Path

import numpy as np

from afkb.flow import NodeKind, TopologicalMap
from afkb.plugins.host import PluginHost
from afkb_mapping.geometry import yaw_of
from afkb_mapping.run import make_map
from afkb_mapping.run_record import Settings
from afkb_simulation.truth import WorldTruth, load_truth

WORLD = "world:paper_home"
HIDDEN, RETURN, TAKEN_AWAY = "kitchen_table", "kitchen_again", "blocks"
NEAR_M = 0.3


def compare(found: TopologicalMap, truth: WorldTruth) -> dict[str, object]:
    T_map_world = np.linalg.inv(truth.T_world_base[0])
    T_map_world[2, 3] = 0.0
    errors, turns = _pose_errors(found, truth, T_map_world)
    at_return = truth.waypoints[RETURN].frames
    table = truth.things[HIDDEN]
    closures = [
        c
        for c in found.closures
        if c.predicted_as is NodeKind.DUAL and _distance(found, c.entity, table, T_map_world) < 0.5
    ]
    rooms = _rooms(found, truth, T_map_world)
    return {
        "position error, m: mean": round(float(errors.mean()), 4),
        "position error, m: greatest": round(float(errors.max()), 4),
        "heading error, degrees: greatest": round(float(np.degrees(turns.max())), 3),
        "loop error of the robot, m (paper: ~0)": round(float(errors[list(at_return)].max()), 4),
        "hidden table predicted at p": [round(c.predicted_probability, 2) for c in closures],
        "hidden table, as predicted, off by m": [round(c.displacement_m, 3) for c in closures],
        "hidden table, as seen, off by m": [
            round(_distance(found, c.entity, table, T_map_world), 3) for c in closures
        ],
        "place nodes (paper: 6)": len(found.places),
        "rooms right (paper: 4/4)": f"{sum(a == b for a, b in rooms.values())}/{len(rooms)}",
        "rooms": {name: f"{is_} taken for {said}" for name, (is_, said) in rooms.items()},
        "taken away, still in the map": _still_there(found, truth, T_map_world),
    }


def _pose_errors(
    found: TopologicalMap, truth: WorldTruth, T_map_world: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    true = [T_map_world @ T for T in truth.T_world_base]
    mapped = [row[1:].reshape(4, 4) for row in found.trajectory]
    if len(true) != len(mapped):
        raise SystemExit(f"{len(mapped)} views mapped of {len(true)}")
    errors = [np.hypot(*(a[:2, 3] - b[:2, 3])) for a, b in zip(true, mapped, strict=True)]
    turns = [abs(yaw_of(np.linalg.inv(a) @ b)) for a, b in zip(true, mapped, strict=True)]
    return np.array(errors), np.array(turns)


def _distance(found: TopologicalMap, id_: str, thing: object, T_map_world: np.ndarray) -> float:
    entity = next(e for e in found.entities if e.id == id_)
    center = T_map_world @ [*thing.box.center_xyz, 1.0]
    return float(np.hypot(*(center[:2] - entity.position_xyz[:2])))


def _rooms(
    found: TopologicalMap, truth: WorldTruth, T_map_world: np.ndarray
) -> dict[str, tuple[str, str]]:
    """Per true room: its category, and the best one of the mapped room most of it lies in."""
    in_room: dict[str, list[str]] = {}
    for row, name in zip(found.trajectory, truth.frame_rooms, strict=True):
        if name is not None:
            x, y = row[4], row[8]
            nearest = min(found.rooms, key=lambda r: _to_room(r, x, y))
            in_room.setdefault(name, []).append(nearest.id)
    rooms = {r.id: r for r in found.rooms}
    result = {}
    for name, ids in in_room.items():
        belief = rooms[max(set(ids), key=ids.count)].belief
        result[name] = (truth.rooms[name].category, max(belief, key=lambda k: belief[k]))
    return result


def _to_room(room: object, x: float, y: float) -> float:
    """Distance of a point outside a room's outline, negative inside, m."""
    import cv2

    outline = room.polygon_xy.astype(np.float32)[:, None]
    return -cv2.pointPolygonTest(outline, (float(x), float(y)), True)


def _still_there(found: TopologicalMap, truth: WorldTruth, T_map_world: np.ndarray) -> list[str]:
    x, y, z, _ = T_map_world @ [*truth.things[TAKEN_AWAY].box.center_xyz, 1.0]
    return [
        e.id
        for e in found.entities
        if e.kind is NodeKind.OBSERVED
        and np.hypot(e.position_xyz[0] - x, e.position_xyz[1] - y) < NEAR_M
        and 0.05 < e.position_xyz[2] < z + NEAR_M
    ]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path)
    parser.add_argument("--mapper", default="affordance")
    parser.add_argument("--json", action="store_true")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        out = arguments.out or Path(scratch) / "map"
        settings = Settings(uri=WORLD, out=out, mapper=arguments.mapper)
        found = make_map(PluginHost(), settings).topological_map
    result = compare(found, load_truth(WORLD))
    if arguments.json:
        json.dump(result, sys.stdout, indent=1)
    else:
        for what, value in result.items():
            print(f"{what}: {value}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
