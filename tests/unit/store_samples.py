"""A small home as plain data: two rooms, a hidden table that was predicted and then seen."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from afkb.flow import (
    Bound,
    Change,
    ChangeKind,
    Closure,
    Doorway,
    Edge,
    EdgeKind,
    Entity,
    LoopKind,
    LoopProposal,
    NodeKind,
    OccupancyGrid,
    PastPrediction,
    PredictionState,
    Region,
    Relation,
    RobotPlace,
    Room,
    TopologicalMap,
)


class Names:
    """Knows the IRIs of a few individuals, as a knowledge base does."""

    known = frozenset(
        ("SupportAbility", "ContainAbility", "Table", "Desk", "Mug", "Bowl", "Kitchen", "Hallway",
         "Small", "Large")
    )  # fmt: skip

    def iri(self, name: str) -> str:
        if name not in self.known:
            raise KeyError(name)
        return f"https://w3id.org/afkb/afnet#{name}"

    def scale_of(self, size_xyz: tuple[float, float, float]) -> str:
        return "Small" if max(size_xyz) < 0.35 else "Large"


def past_prediction() -> PastPrediction:
    """The hidden table, before it was seen."""
    steps = (
        Change(ChangeKind.PREDICTED, 0.7, None, 0.7, 1.5, 0, ("n2",)),
        Change(ChangeKind.CONFIRMED, 1.0, 0.7, 1.0, 9.25, 40, ("n1",)),
    )
    return PastPrediction(
        id="n4",
        kind=NodeKind.DUAL.value,
        state=PredictionState.CONFIRMED,
        position_xyz=(2.1, 1.1, 0.72),
        affordances={"SupportAbility": 1.0},
        probability=0.7,
        relation=Relation.BELOW,
        first_seen=1.5,
        ended=9.25,
        history=steps,
        generated_by="filtrations",
        predicted_from=("n2",),
        axioms=("https://w3id.org/afkb/afnet#dual-contain-support",),
        seen_as="n1",
    )


def square(x: float, y: float, half: float) -> np.ndarray:
    return np.array(
        [[x - half, y - half], [x + half, y - half], [x + half, y + half], [x - half, y + half]]
    )


def entity(id: str, kind: NodeKind = NodeKind.OBSERVED, **changes: object) -> Entity:
    facts: dict[str, object] = {
        "id": id,
        "kind": kind,
        "position_xyz": (2.0, 1.0, 0.73),
        "size_xyz": (1.2, 0.8, 0.73),
        "yaw": 0.1,
        "affordances": {"SupportAbility": 0.97},
        "existence": 0.98,
        "category_belief": {"Table": 0.7, "Desk": 0.2, "SomethingElse": 0.1},
        "movability": "Static",
        "matching_weight": 1.0,
        "observations": 4,
        "first_seen": 1.5,
        "last_seen": 9.25,
        "seen_from": ("p1", "p2"),
        "generated_by": ("surfaces",),
        "room": "room1",
    }
    return Entity(**(facts | changes))  # type: ignore[arg-type]


def sample_entities() -> tuple[Entity, ...]:
    table = entity(
        "n1",
        predicted_first=NodeKind.DUAL,
        polygon_xy=square(2, 1, 0.5),
        axioms=("https://w3id.org/afkb/afnet#dual-contain-support",),
    )
    mug = entity(
        "n2",
        position_xyz=(2.1, 1.1, 0.78),
        size_xyz=(0.09, 0.08, 0.1),
        affordances={"ContainAbility": 0.9, "GraspAbility": 0.4},
        category_belief={"Mug": 0.6, "Bowl": 0.3, "SomethingElse": 0.1},
        movability="Dynamic",
        matching_weight=0.3,
        supported_by="n1",
        generated_by=("containers",),
    )
    doubtful = entity(
        "n10",
        position_xyz=(4.0, 1.0, 0.45),
        affordances={"SupportAbility": 0.4},
        extent_known=False,
        room=None,
    )
    predicted = entity(
        "n3",
        NodeKind.CO_OCCURRENCE,
        position_xyz=(2.5, 1.8, 0.7),
        existence=0.65,
        predicted_from=("n2",),
        generated_by=("filtrations",),
        axioms=("https://w3id.org/afkb/afnet#cooc-chair-table",),
        region=Region(
            Relation.NEAR, np.array([[2.5, 1.8, 0.75], [2.75, 1.8, 0.25]]), 0.25, (0.62, 0.84)
        ),
        state=PredictionState.PREDICTED,
        history=(Change(ChangeKind.PREDICTED, 0.65, None, 0.65, 1.5, 0, ("n2",)),),
    )
    return table, mug, doubtful, predicted


def pose_row(stamp: float, x: float, y: float) -> list[float]:
    """A row of the trajectory: the stamp, then T_map_base row by row."""
    T = np.eye(4)
    T[:2, 3] = x, y
    return [stamp, *T.ravel()]


def sample_grid() -> OccupancyGrid:
    probability = np.full((30, 60), np.nan, dtype=np.float32)
    probability[2:28, 2:58] = 0.05
    probability[2, 2:58] = 0.95
    probability[10:14, 20:26] = 0.65
    return OccupancyGrid(probability, 0.1, (-1.0, -0.5))


def sample_loop(accepted: bool) -> LoopProposal:
    kind, why = LoopKind.CONSTELLATION, "borne out" if accepted else "odometry rules it out"
    found = LoopProposal(kind, 40, 0, 9.25, 1.5, 3.2, accepted, why, 0.48, 0.13)
    return replace(found, place="p2", earlier_place="p1")


def sample_map() -> TopologicalMap:
    return TopologicalMap(
        places=(RobotPlace("p1", 0, 0, 0, 1.5, 0, "room1"), RobotPlace("p2", 1, 1, 1.57, 9.25, 40)),
        entities=sample_entities(),
        bounds=(
            Bound("b1", (-1, -0.3), (4.7, -0.3), 12, ("laser_bounds",), "room1", (0.01, 0.005)),
        ),
        doorways=(Doorway("d1", 3.5, 1.0, 0.0, 0.9, ("room1", "room2")),),
        rooms=(
            Room(
                "room1",
                1,
                1,
                8.0,
                square(1, 1, 1.4),
                {"Kitchen": 0.7, "UnknownRoom": 0.3},
                other_beliefs={"by-colour": {"Bedroom": 0.25, "UnknownRoom": 0.75}},
                second_purpose=("DiningRoom", 0.9),
            ),
            Room("room2", 4, 1, 3.2, square(4, 1, 0.9), {"UnknownRoom": 1.0}, visited=False),
        ),
        edges=(
            Edge("e1", EdgeKind.PATH, "p1", "p2", 1.4142135, 0.7853981),
            Edge("e2", EdgeKind.OBSTACLE, "p2", "n1", 1.0, 0.0, 0.785),
            Edge("e3", EdgeKind.BOUND, "p1", "b1", 0.3, -1.5708),
        ),
        grid=sample_grid(),
        T_map_source=np.eye(4),
        trajectory=np.array([pose_row(0, 0, 0), pose_row(5, 0.5, 0.4), pose_row(9, 1, 1)]),
        closures=(Closure("n1", NodeKind.DUAL, 0.7, 0.12, "p2", 9.25),),
        past_predictions=(past_prediction(),),
        loops=(sample_loop(True), sample_loop(False)),
        notes=("n10: its top returns almost no depth; its extent is unknown",),
        counts={"frames": 41, "skipped_frames": 1},
    )
