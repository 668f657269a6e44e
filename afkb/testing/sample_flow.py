"""Detections and a small finished map, written out by hand, for checks that need some."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from afkb.flow import (
    Bound,
    Detection,
    Edge,
    EdgeKind,
    Entity,
    Hypothesis,
    NodeKind,
    OccupancyGrid,
    OrientedBox,
    Relation,
    RobotPlace,
    Room,
    TopologicalMap,
)

XYZ = tuple[float, float, float]


def _detection(affordances: Mapping[str, float], center_xyz: XYZ, size_xyz: XYZ) -> Detection:
    """A detection of a box, its position at the middle of the top if it supports things."""
    box = OrientedBox(center_xyz, size_xyz)
    x, y, z = center_xyz
    xs = np.linspace(x - size_xyz[0] / 2, x + size_xyz[0] / 2, 12)
    ys = np.linspace(y - size_xyz[1] / 2, y + size_xyz[1] / 2, 12)
    return Detection(
        detector="sample",
        affordances=affordances,
        box=box,
        position_xyz=np.array([x, y, box.top if "SupportAbility" in affordances else z]),
        covariance_xyz=np.eye(3) * 1e-4,
        footprint_xy=np.array([(a, b) for a in xs for b in ys]),
        n_pixels=2000,
        range_m=float(np.hypot(x, y)),
        image_box=(100, 100, 140, 140),
    )


def sample_detections() -> tuple[Detection, ...]:
    """A table with a cup on it, a chair's seat, and two cups whose support is not seen."""
    cup, size = {"ContainAbility": 0.9}, (0.09, 0.09, 0.11)
    return (
        _detection({"SupportAbility": 0.95}, (1.8, 0.0, 0.71), (0.8, 1.2, 0.04)),
        _detection(cup, (1.7, 0.2, 0.785), size),
        _detection({"SupportAbility": 0.9}, (1.1, 0.0, 0.43), (0.42, 0.42, 0.04)),
        _detection(cup, (3.0, 1.0, 0.955), size),
        _detection(cup, (3.0, 1.3, 0.955), size),
    )


def sample_hypotheses() -> tuple[Hypothesis, ...]:
    """What follows from `sample_detections`: something supports the two cups in mid-air."""
    return (
        Hypothesis(
            predictor="sample",
            order=1,
            relation=Relation.BELOW,
            anchors=(3, 4),
            affordances={"SupportAbility": 0.7},
            scale="Large",
            probability=0.7,
            axiom="https://w3id.org/afkb/afnet#ContainPredictsSupportBelow",
            distance_m=(0.0, 0.2),
            size_xy_m=(1.2, 0.8),
        ),
    )


def _entity(id_: str, kind: NodeKind, position: XYZ, size: XYZ, feature: str) -> Entity:
    seen = kind is NodeKind.OBSERVED
    return Entity(
        id=id_,
        kind=kind,
        position_xyz=position,
        size_xyz=size,
        yaw=0.0,
        affordances={feature: 0.9},
        existence=0.97 if seen else 0.7,
        category_belief={"Table": 0.8, "SomethingElse": 0.2},
        movability="Static",
        matching_weight=1.0,
        observations=2,
        first_seen=0.0,
        last_seen=0.1,
        seen_from=("place-1",) if seen else (),
        generated_by=("sample",),
        room="room-1",
        predicted_from=() if seen else ("thing-2",),
    )


def sample_map() -> TopologicalMap:
    """One room with a place, a table, a cup on an unseen support, a wall and a grid."""
    grid = np.full((40, 60), np.nan, dtype=np.float32)
    grid[5:35, 5:55] = 0.1
    grid[5, 5:55] = 0.95
    outline = np.array([[-1.0, -2.0], [4.0, -2.0], [4.0, 2.0], [-1.0, 2.0]])
    return TopologicalMap(
        places=(RobotPlace("place-1", 0.0, 0.0, 0.0, 0.0, 0, "room-1"),),
        entities=(
            _entity(
                "thing-1", NodeKind.OBSERVED, (1.8, 0, 0.73), (0.8, 1.2, 0.04), "SupportAbility"
            ),
            _entity(
                "thing-2", NodeKind.OBSERVED, (3, 1, 0.955), (0.09, 0.09, 0.11), "ContainAbility"
            ),
            _entity("thing-3", NodeKind.DUAL, (3, 1, 0.9), (0.6, 0.6, 0.04), "SupportAbility"),
        ),
        bounds=(Bound("bound-1", (-1.0, -2.0), (4.0, -2.0), 2, ("sample",), "room-1"),),
        doorways=(),
        rooms=(Room("room-1", 1.0, 0.0, 20.0, outline, {"Kitchen": 0.6, "UnknownRoom": 0.4}),),
        edges=(Edge("edge-1", EdgeKind.OBSTACLE, "place-1", "thing-1", 1.8, 0.0),),
        grid=OccupancyGrid(grid, 0.1, (-1.5, -2.5)),
        T_map_source=np.eye(4),
        trajectory=np.array([[0.0, *np.eye(4).ravel()]]),
    )
