"""The structure of the network, node by node, with the statements of the ontology behind each."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from afkb.inference.contents import ContentsNetwork
from afkb.inference.pgm import CATEGORY, ROOM, SHARE
from afkb.knowledge import AfNet

if TYPE_CHECKING:
    from afkb.inference.network import Network


@dataclass(frozen=True, slots=True)
class Node:
    """A node that was read from the ontology: what it is, what it depends on, and who says so.

    `parents`: their names, as in BIF; of a chain of ORs, those of the whole chain. `statements`:
    names of those that its table is made of.
    """

    name: str
    what: str
    parents: tuple[str, ...]
    statements: tuple[str, ...]


def structure(network: Network) -> tuple[Node, ...]:
    """All nodes, parents before children."""
    kb = network.knowledge_base
    return (
        Node(CATEGORY, "what a thing is", (), tuple(network.objects.categories)),
        *_features(network),
        Node(ROOM, "what a room is for", (), tuple(network.rooms.rooms)),
        Node(SHARE, "how much of it was seen", (), ()),
        *_placed(kb),
        *_counts(network),
        *_contents(network.contents_network, kb),
        *_relations(network),
    )


def _features(network: Network) -> Iterator[Node]:
    for name in network.objects.features:
        told = sorted({a.name for a in network.knowledge_base.afbits if a.feature == name})
        yield Node(name, "affordance of a thing", (CATEGORY,), tuple(told))
    for name in network.objects.measures:
        yield Node(name, "measure of a thing", (CATEGORY,), tuple(network.objects.categories))


def _placed(kb: AfNet) -> Iterator[Node]:
    """What a thing is, beside others of the room: the same table as often as there are things."""
    in_rooms = tuple(f.name for f in kb.objects_in_rooms)
    yield Node(f"{CATEGORY}InRoom", "what a thing is, by its room", (ROOM,), in_rooms)
    carried = tuple(f.name for f in kb.objects_on_supports)
    parents = (f"{CATEGORY}InRoom", f"{CATEGORY}OfSupport")
    yield Node(f"{CATEGORY}OnSupport", "what a thing is, by its support", parents, carried)


def _counts(network: Network) -> Iterator[Node]:
    rooms = network.knowledge_base.rooms.values()
    for name in network.rooms.counts:
        told = tuple(f"{r.name}.{name}" for r in rooms if name in r.expected_counts)
        yield Node(name, "number of things of a class", (ROOM, SHARE), told)


def _contents(network: ContentsNetwork, kb: AfNet) -> Iterator[Node]:
    in_rooms: dict[str, list[str]] = {}
    for figure in kb.objects_in_rooms:
        in_rooms.setdefault(figure.category, []).append(figure.name)
    sources: dict[int, list[str]] = {}
    together: dict[int, list[str]] = {}
    for cause in network.causes:
        sources.setdefault(cause.effect, []).append(f"{network.categories[cause.source]}InRoom")
        together.setdefault(cause.effect, []).extend(cause.statements)
    for i, name in enumerate(network.categories):
        parents = (ROOM, SHARE, *sources.get(i, ()))
        told = (*in_rooms.get(name, ()), *together.get(i, ()))
        yield Node(f"{name}InRoom", "whether a room holds one", parents, told)


def _relations(network: Network) -> Iterator[Node]:
    for name in network.relations.duals:
        yield Node(f"{name}There", "other half of a dual", (f"{name}Seen",), (name,))
    for name in network.relations.rules:
        yield Node(f"{name}There", "larger thing near by", (f"{name}Anchor",), (name,))
