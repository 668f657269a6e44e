"""Where a thing of some kind is or would be: regions of a map, with the probability of each."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from afkb.finding.names import label_of
from afkb.finding.surroundings import Node, RoomNode, Surroundings
from afkb.finding.unseen import ELSEWHERE, UNKNOWN, Unseen
from afkb.finding.untold import share_of

if TYPE_CHECKING:
    from afkb.knowledge import AfNet


@dataclass(frozen=True, slots=True)
class Region:
    """A place where, with a probability, there is such a thing; map frame, m.

    `node` is the thing itself (`how` is `thing`), what it would stand on (`support`), or the room
    in which it would be elsewhere (`room`). `seen`: whether what may be it was seen. `parts`: of a
    predicted thing the places where it may be, (x, y, share), of which `x`, `y` is the likeliest.
    """

    node: str
    how: str
    x: float
    y: float
    z: float
    room: str | None
    probability: float
    seen: bool
    reason: str
    parts: tuple[tuple[float, float, float], ...] = ()


def regions(category: str, around: Surroundings, kb: AfNet) -> list[Region]:
    """All regions of a map, the likeliest first (paper §I: task-driven, top-down search).

    What was seen or is expected may be one, by its existence and category belief, narrower
    categories included. Any room may hold one that was overlooked: its posterior times how many
    such rooms hold, spread over what it would be put on, less what was looked at in vain.

    Regions are independent of each other, so that P(somewhere) is 1 - Π(1 - p) over them all.
    """
    kinds = [name for name in kb.categories if category in kb.kinds_of(name)]
    label = label_of(category, kb)
    things = {node.id: _thing(node, kinds, label, kb) for node in around.nodes.values()}
    nodes: defaultdict[str | None, list[Node]] = defaultdict(list)
    for node in around.nodes.values():
        nodes[node.room if node.room in around.rooms else None].append(node)
    unseen = Unseen.of(category, kinds, kb)
    found = list(things.values())
    for name in (*around.rooms, None):
        room = around.rooms.get(name or "")
        none = math.prod(1.0 - things[node.id].probability for node in nodes[name])
        if room or nodes[None]:
            found += _unseen(unseen, room, nodes[name], 1.0 - none)
    found = [region for region in found if region.probability > 0]
    return sorted(found, key=lambda r: (-r.probability, r.node, r.how))


def somewhere(found: Iterable[Region]) -> float:
    """P(there is one in at least one of the regions)."""
    return 1.0 - math.prod(1.0 - region.probability for region in found)


def _thing(node: Node, kinds: list[str], label: str, kb: AfNet) -> Region:
    """The node itself, as such a thing."""
    share = share_of(node, kinds, kb)
    how = "seen" if node.seen else "expected"
    where = f", on {node.supported_by}" if node.supported_by else ""
    reason = (
        f"{node.id}, {how}{where}: exists with {node.existence:.2f}, is a {label} with {share:.2f}"
    )
    p = min(node.existence * share, 1.0)
    at = (node.x, node.y, node.z)
    return Region(node.id, "thing", *at, node.room, p, node.seen, reason, node.parts)


def _unseen(
    unseen: Unseen, room: RoomNode | None, nodes: list[Node], recognised: float
) -> Iterator[Region]:
    """On what carries things in a room, and elsewhere in it: nowhere without one."""
    belief = room.belief if room else UNKNOWN
    likeliest = next(iter(belief), "UnknownRoom")
    such = (
        f"{likeliest} {belief.get(likeliest, 0.0):.2f}, "
        f"such rooms hold one with {unseen.probability(belief):.2f}"
    )
    by_id = {node.id: node for node in nodes}
    for name, p in unseen.places(room, nodes, recognised).items():
        if name != ELSEWHERE:
            node = by_id[name]
            what = next(iter(node.belief), "support")
            why = f"on {name}, {what} {node.belief.get(what, 0.0):.2f}, {_looks(node)}; {such}"
            yield Region(name, "support", node.x, node.y, node.z, node.room, p, False, why)
        elif room is not None:
            why = f"elsewhere in {room.id}, {_looks(room)}; {such}"
            yield Region(room.id, "room", room.x, room.y, 0.0, room.id, p, False, why)


def _looks(at: Node | RoomNode) -> str:
    if at.viewpoints:
        return f"seen from {at.viewpoints} place{'s' if at.viewpoints > 1 else ''}"
    return "not seen" if isinstance(at, Node) else "never entered"
