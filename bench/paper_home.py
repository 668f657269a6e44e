"""The map of the paper's simulated home (Fig. 2) beside the truth of that home.

    python -m bench.paper_home [--out MAP] [--mapper affordance] [--json]

Prints the paper's figures and ours. The map is made without the truth; only this comparison reads
it: error of the robot's position (m; where it comes back to a room, apart),
the hidden table's place (m), rooms by their category, and whether what was taken away is gone.
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
from pathlib import Path

import numpy as np

from afkb.flow import NodeKind, TopologicalMap, TrueThing, Truth
from afkb.plugins.host import PluginHost
from afkb_mapping.run import make_map
from afkb_mapping.run_record import Settings
from afkb_paper.judged import Judged, return_errors
from afkb_paper.moving import nodes_at
from afkb_paper.rooms import AFFORDANCES, judged_rooms

WORLD = "world:paper_home"
HIDDEN, TAKEN_AWAY = "kitchen_table", "blocks"
NEAR_M = 0.5


def compare(found: TopologicalMap, truth: Truth) -> dict[str, object]:
    judged, things = Judged.of(found, truth), {t.name: t for t in truth.things}
    views = list(judged.views())
    errors, turns = np.array([v[1] for v in views]), np.array([v[2] for v in views])
    table = things[HIDDEN]
    closures = [
        c
        for c in found.closures
        if c.predicted_as is NodeKind.DUAL and _distance(judged, c.entity, table) < NEAR_M
    ]
    rooms = judged_rooms(found, truth)
    return {
        "position error, m: mean": round(float(errors.mean()), 4),
        "position error, m: greatest": round(float(errors.max()), 4),
        "heading error, degrees: greatest": round(float(np.degrees(turns.max())), 3),
        "loop error of the robot, m (paper: ~0)": round(max(return_errors(judged)), 4),
        "hidden table predicted at p": [round(c.predicted_probability, 2) for c in closures],
        "hidden table, as predicted, off by m": [round(c.displacement_m, 3) for c in closures],
        "hidden table, as seen, off by m": [
            round(_distance(judged, c.entity, table), 3) for c in closures
        ],
        "place nodes (paper: 6)": len(found.places),
        "rooms right (paper: 4/4)": f"{sum(r.is_right(AFFORDANCES) for r in rooms)}/{len(rooms)}",
        "rooms": {r.name: f"{r.category} taken for {r.told(AFFORDANCES)}" for r in rooms},
        "taken away, still in the map": [
            e.id for e in nodes_at(found, judged.box(things[TAKEN_AWAY]))
        ],
    }


def _distance(judged: Judged, id_: str, thing: TrueThing) -> float:
    entity = next(e for e in judged.found.entities if e.id == id_)
    return float(np.hypot(*np.subtract(judged.box(thing).center_xyz, entity.position_xyz)[:2]))


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path)
    parser.add_argument("--mapper", default="affordance")
    parser.add_argument("--json", action="store_true")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        out = arguments.out or Path(scratch) / "map"
        settings = Settings(uri=WORLD, out=out, mapper=arguments.mapper)
        host = PluginHost()
        found = make_map(host, settings).topological_map
    truth = host.truth(WORLD)
    assert truth is not None
    result = compare(found, truth)
    if arguments.json:
        json.dump(result, sys.stdout, indent=1)
    else:
        for what, value in result.items():
            print(f"{what}: {value}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
