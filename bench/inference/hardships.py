"""What inference makes of bad input: a clear answer or a clear error, in bounded time.

    python -m bench.inference hardships [--json]

Evidence that contradicts itself or that the model holds for impossible, extensions that go round in
circles, 500 further categories, and a room of 2,000 things. Each line says what came of it and how
long it took (CPU seconds). Anything but an answer that sums to 1 or an `AfkbError` would be a bug.
"""

from __future__ import annotations

import argparse
import math
import tempfile
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from afkb.errors import AfkbError
from afkb.flow import Entity, NodeKind, OccupancyGrid
from afkb.inference import Network
from afkb.knowledge import SOMETHING_ELSE, AfNet
from afkb_mapping.rooms.evidence import RoomEvidence
from afkb_mapping.rooms.two_purposes import second_purpose
from afkb_mapping.things.recognition import recognised

CATEGORIES, THINGS = 500, 2000
ROOM_M, RESOLUTION_M = 12.0, 0.05
SEED = 1
SIZES = "    length_m: [0.2, 0.4]\n    width_m: [0.2, 0.4]\n    height_m: [0.5, 0.9]\n"
CIRCLES = {
    "categories broader than each other": (
        f"categories:\n  Kiosk:\n    broader: Stall\n{SIZES}  Stall:\n    broader: Kiosk\n{SIZES}"
    ),
    "co-occurrences in a circle": "co_occurrences:\n"
    + "".join(
        f"  {name}: {{feature: SupportAbility, evidence_category: {seen}, "
        f"predicted_category: {unseen}, strength: 0.9, size_m: [1, 1]}}\n"
        for name, seen, unseen in (("There", "Chair", "Desk"), ("Back", "Desk", "Chair"))
    ),
    "duals in a circle": """duals:
  There: {evidence: SupportAbility, predicted: ContainAbility, relation: on, strength: 0.9,
    size_m: [0.3, 0.3]}
  Back: {evidence: ContainAbility, predicted: SupportAbility, relation: below, strength: 0.9,
    size_m: [1, 1]}
""",
}
"""Extensions that go round: what is broader than itself means nothing; predictions may return."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """It takes no data."""


def run(args: argparse.Namespace) -> list[dict[str, Any]]:
    """A row per hardship: what came of it, and CPU seconds."""
    network = Network.compile(AfNet())
    rows = [_asked(what, ask) for what, ask in _evidence(network).items()]
    with tempfile.TemporaryDirectory() as scratch:
        for what, text in CIRCLES.items():
            rows.append(_asked(what, lambda text=text: _extended(Path(scratch), text)))
        many = many_categories()
        rows.append(
            _asked(f"{CATEGORIES} further categories", lambda: _extended(Path(scratch), many))
        )
    things = crowd()
    grid, evidence = crowded(network, things)
    room = np.ones(grid.probability.shape, dtype=bool)
    prior = network.room_posterior({})
    rows.append(_asked(f"{THINGS} things in a room", lambda: evidence.posterior(room)))
    heap = [things[1], *(replace(t, supported_by=things[1].id) for t in things[2:])]
    rows.append(_asked(f"{THINGS} things on one table", lambda: _joint(heap, network)))
    rows.append(_asked(f"{THINGS} recognised things", lambda: _recognised(network)))

    def second() -> dict[str, float]:
        found = second_purpose(room, grid, evidence.purpose, prior)
        return {found[0]: 1.0} if found else {"no second purpose": 1.0}

    rows.append(_asked(f"{THINGS} things, two purposes?", second))
    return rows


def _asked(what: str, ask: Callable[[], Mapping[str, float]]) -> dict[str, Any]:
    begun = time.process_time()
    try:
        belief = ask()
        best = max(belief, key=lambda name: belief[name])
        good = math.isclose(sum(belief.values()), 1.0, abs_tol=1e-6)
        came = f"{best} {belief[best]:.2f}" + ("" if good else ", which DOES NOT SUM TO 1")
    except AfkbError as error:
        came = f"error: {error}"
    return {"what": what, "came_of_it": came, "seconds": round(time.process_time() - begun, 3)}


def _evidence(network: Network) -> dict[str, Callable[[], Mapping[str, float]]]:
    """Questions about things and rooms that no home answers."""
    features = network.knowledge_base.features

    def thing(p: float, size_m: float = 0.2, top_m: float = 1.0) -> dict[str, float]:
        return network.category_posterior(dict.fromkeys(features, p), (size_m,) * 3, top_m)

    return {
        "a thing that affords everything": lambda: thing(1.0),
        "a thing that affords nothing": lambda: thing(0.0),
        "a thing as large as a town": lambda: thing(0.5, size_m=1e4, top_m=1e4),
        "a thing without a size": lambda: thing(0.5, size_m=math.nan),
        "an affordance that is 1.5 sure": lambda: thing(1.5),
        "a room with a billion of all": lambda: network.room_posterior(
            dict.fromkeys(network.evidence_looked_for(features), 10**9)
        ),
        "a kitchen of beds and toilets": lambda: network.room_posterior(
            {"BedSupport": 9, "CounterHeightSupport": 0}, {"Bed": 999, "Toilet": 999, "Stove": 0}
        ),
        "a room with a unicorn": lambda: network.room_posterior({}, {"Unicorn": 1}),
        "a room with minus one bed": lambda: network.room_posterior({"BedSupport": -1}),
        "a room with half a bed": lambda: network.room_posterior({"BedSupport": 0.5}),
        "a room with what nobody counts": lambda: network.room_posterior({"Beds": 1}),
    }


def _recognised(network: Network) -> Mapping[str, float]:
    """What a room is for that holds things of every category, and then what else it holds."""
    names = [n for n in network.knowledge_base.categories if n != SOMETHING_ELSE]
    belief = network.room_posterior({}, {n: max(1, THINGS // len(names)) for n in names})
    network.contents(belief, dict.fromkeys(names, 1))
    return belief


def _joint(things: Sequence[Entity], network: Network) -> Mapping[str, float]:
    """What the first of things that stand together is, told together with them all."""
    return recognised(things, lambda room: {}, network)[0].category_belief


def _extended(folder: Path, text: str) -> dict[str, float]:
    """What a network with this extension takes a table for; the error, if it is refused."""
    path = folder / "hard.yaml"
    path.write_text(f"extension: hard\n{text}")
    network = Network.compile(AfNet(extensions=[path]))
    return network.category_posterior({"SupportAbility": 0.95}, (1.4, 0.8, 0.04), 0.73)


def many_categories(number: int = CATEGORIES) -> str:
    """The categories section of an extension with many."""
    return "categories:\n" + "".join(
        f"  Thing{i}:\n    broader: Furniture\n{SIZES}"
        f'    afbits: ["SupportAbility = 0.{i % 9 + 1}", "ContainAbility = 0.{(i + 4) % 9 + 1}"]\n'
        for i in range(number)
    )


def crowd() -> list[Entity]:
    """Things all over a square room, half of them supports, half containers."""
    spots = np.random.default_rng(SEED).uniform(0.1, ROOM_M - 0.1, (THINGS, 2))
    return [
        Entity(
            id=f"thing-{i}",
            kind=NodeKind.OBSERVED,
            position_xyz=(float(x), float(y), 0.75),
            size_xyz=(0.9, 0.6, 0.02) if i % 2 else (0.09, 0.09, 0.1),
            yaw=0.0,
            affordances={"SupportAbility" if i % 2 else "ContainAbility": 0.95},
            existence=1.0,
            category_belief={},
            movability="Static",
            matching_weight=1.0,
            observations=3,
            first_seen=0.0,
            last_seen=1.0,
            seen_from=(),
            generated_by=("bench",),
        )
        for i, (x, y) in enumerate(spots)
    ]


def crowded(network: Network, things: Sequence[Entity]) -> tuple[OccupancyGrid, RoomEvidence]:
    """The square room of a crowd, looked into from one of its things."""
    cells = round(ROOM_M / RESOLUTION_M)
    grid = OccupancyGrid(np.zeros((cells, cells), dtype=np.float32), RESOLUTION_M, (0.0, 0.0))
    labels = np.ones((cells, cells), dtype=np.int32)
    looked_from = [np.array(things[0].position_xyz[:2])]
    return grid, RoomEvidence(network, things, looked_from, labels, grid)


def table(result: list[dict[str, Any]]) -> Iterator[str]:
    """A line per hardship."""
    for row in result:
        came = row["came_of_it"]
        short = came if len(came) < 110 else came[:107] + "…"
        yield f"{row['what']:36} {row['seconds']:7.2f} s  {short}"
