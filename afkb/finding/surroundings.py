"""What finding needs to know of a stored map: its things, its rooms and its walls."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import pairwise
from statistics import median
from typing import TYPE_CHECKING

from pyoxigraph import NamedNode

from afkb.store.vocabulary import local_name

if TYPE_CHECKING:
    from afkb.store import StoredMap

SEEN = "ObservedEntity"
THING_KINDS = (SEEN, "DualPrediction", "CoOccurrencePrediction")
Point = tuple[float, float]


@dataclass(frozen=True, slots=True)
class Node:
    """A thing, seen or expected; map frame, m and rad.

    `z`: of a support its top, of anything else the middle of its box. `affords`: feature to
    probability. `viewpoints`: from how many places of the robot it was seen. `parts`: of a
    predicted one where its middle may be, (x, y, share), the shares adding up to 1.
    """

    id: str
    kind: str
    x: float
    y: float
    z: float
    existence: float
    belief: Mapping[str, float]
    room: str | None = None
    supported_by: str | None = None
    size: tuple[float, float, float] = (0.0, 0.0, 0.0)
    yaw: float = 0.0
    affords: Mapping[str, float] = field(default_factory=dict)
    viewpoints: int = 0
    parts: tuple[tuple[float, float, float], ...] = ()

    @property
    def seen(self) -> bool:
        """Whether it was seen, and not only expected."""
        return self.kind == SEEN

    @property
    def supports(self) -> bool:
        """Whether it is more likely than not something that things stand on."""
        return self.affords.get("SupportAbility", 0.0) > 0.5

    @property
    def bottom_top(self) -> Point:
        """Heights of its lower and upper end above the floor, m."""
        if self.supports:
            return self.z - self.size[2], self.z
        return self.z - self.size[2] / 2, self.z + self.size[2] / 2


@dataclass(frozen=True, slots=True)
class RoomNode:
    """A room with the posterior over what it is for.

    `viewpoints`: from how many places it was looked at: in which the robot stood, or from which its
    things mostly were seen, as one looks in, too.
    """

    id: str
    x: float
    y: float
    belief: Mapping[str, float]
    viewpoints: int = 0


@dataclass(frozen=True, slots=True)
class Surroundings:
    """A map as finding sees it: things and rooms by id, walls as lines, m, map frame."""

    nodes: Mapping[str, Node] = field(default_factory=dict)
    rooms: Mapping[str, RoomNode] = field(default_factory=dict)
    walls: tuple[tuple[Point, Point], ...] = ()

    @classmethod
    def of(cls, stored: StoredMap) -> Surroundings:
        """Those of a stored map."""
        places = stored.instances("RobotPlace")
        stood = Counter(stored.name(place, "afn:inRoom") for place in places)
        nodes = [_node(stored, n, kind) for kind in THING_KINDS for n in stored.instances(kind)]
        looks: defaultdict[str | None, list[int]] = defaultdict(list)
        for node in nodes:
            if node.seen:
                looks[node.room].append(node.viewpoints)
        rooms = [_room(stored, n, stood, looks) for n in stored.instances("Room")]
        lines = [stored.outline(n) for n in stored.instances("Bound")]
        return cls(
            {node.id: node for node in nodes},
            {room.id: room for room in rooms},
            tuple(
                ((a[0], a[1]), (b[0], b[1])) for line in lines if line for a, b in pairwise(line)
            ),
        )


def _node(stored: StoredMap, node: NamedNode, kind: str) -> Node:
    x, y, z = (stored.number(node, f"afn:{axis}") for axis in "xyz")
    a, b, c = (stored.number(node, f"afn:size{axis}") for axis in "XYZ")
    affords = dict.fromkeys(stored.names(node, "afn:affords"), 1.0)
    return Node(
        id=local_name(node.value),
        kind=kind,
        x=x,
        y=y,
        z=z,
        existence=stored.number(node, "afn:existence", 1.0),
        belief=stored.belief(node, "category", "category"),
        room=stored.name(node, "afn:inRoom"),
        supported_by=stored.name(node, "afn:supportedBy"),
        size=(a, b, c),
        yaw=stored.number(node, "afn:yaw"),
        affords=affords | stored.belief(node, "affordance", "affordance"),
        viewpoints=len(stored.names(node, "afn:seenFrom")) if kind == SEEN else 0,
        parts=_parts(stored, node),
    )


def _parts(stored: StoredMap, node: NamedNode) -> tuple[tuple[float, float, float], ...]:
    """The parts of a prediction's region, the likeliest first."""
    found = [
        (
            stored.number(part, "afn:x"),
            stored.number(part, "afn:y"),
            stored.number(part, "afn:probability"),
        )
        for name in stored.names(node, "afn:regionPart")
        for part in (NamedNode(stored.base + name),)
    ]
    return tuple(sorted(found, key=lambda part: (-part[2], part[:2])))


def _room(
    stored: StoredMap,
    node: NamedNode,
    stood: Mapping[str | None, int],
    looks: Mapping[str | None, list[int]],
) -> RoomNode:
    name = local_name(node.value)
    return RoomNode(
        name,
        stored.number(node, "afn:x"),
        stored.number(node, "afn:y"),
        stored.belief(node, "room", "roomCategory"),
        max(stood.get(name, 0), round(median(looks.get(name, [0])))),
    )
