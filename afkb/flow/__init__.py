"""The vocabulary of the flow: what passes from room to room, as frozen plain data.

source → `View` → detectors → `Detection` → filtrations and network → `Hypothesis` → mapper
→ `TopologicalMap` → store, exports, report.
"""

from afkb.flow.detection import Detection, OrientedBox, Primitive
from afkb.flow.evidence import Change, ChangeKind, Sighting
from afkb.flow.hypothesis import Hypothesis, Relation
from afkb.flow.loops import LoopKind, LoopProposal
from afkb.flow.prediction import (
    PastPrediction,
    PredictionState,
    Region,
)
from afkb.flow.sensing import LaserScan, PinholeCamera, SkippedFrame, View
from afkb.flow.topological_map import (
    Bound,
    Closure,
    Doorway,
    Edge,
    EdgeKind,
    Entity,
    NodeKind,
    OccupancyGrid,
    RobotPlace,
    Room,
    TopologicalMap,
)
from afkb.flow.truth import TrueThing, TrueView, Truth

__all__ = [
    "Bound",
    "Change",
    "ChangeKind",
    "Closure",
    "Detection",
    "Doorway",
    "Edge",
    "EdgeKind",
    "Entity",
    "Hypothesis",
    "LaserScan",
    "LoopKind",
    "LoopProposal",
    "NodeKind",
    "OccupancyGrid",
    "OrientedBox",
    "PastPrediction",
    "PinholeCamera",
    "PredictionState",
    "Primitive",
    "Region",
    "Relation",
    "RobotPlace",
    "Room",
    "Sighting",
    "SkippedFrame",
    "TopologicalMap",
    "TrueThing",
    "TrueView",
    "Truth",
    "View",
]
