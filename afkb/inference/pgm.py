"""The networks as pgmpy models: the tests' oracle, and what is written as BIF."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from afkb.inference.bands import Array
from afkb.inference.contents import ContentsNetwork
from afkb.inference.numbers import NUMBER_STARTS, number_table
from afkb.inference.objects import ObjectNetwork
from afkb.inference.relations import RelationshipNetwork
from afkb.inference.rooms import COUNT_BINS, RoomNetwork

if TYPE_CHECKING:
    from afkb.inference.network import Network

CATEGORY, ROOM, SHARE = "ObjectCategory", "RoomCategory", "ShareSeen"
NO_YES = ["no", "yes"]


class _Builder:
    """Collects nodes and tables, then makes one checked pgmpy network of them."""

    def __init__(self) -> None:
        self.states: dict[str, list[str]] = {}
        self.edges: list[tuple[str, str]] = []
        self.tables: list[Any] = []

    def add(self, name: str, states: list[str], table: Array, parents: list[str]) -> None:
        """A node with its table (states, product of the parents' states in their order)."""
        from pgmpy.factors.discrete import TabularCPD

        self.states[name] = states
        self.edges += [(parent, name) for parent in parents]
        self.tables.append(
            TabularCPD(
                name,
                len(states),
                table.reshape(len(states), -1).tolist(),
                evidence=parents or None,
                evidence_card=[len(self.states[p]) for p in parents] or None,
                state_names={n: self.states[n] for n in [name, *parents]},
            )
        )

    def model(self) -> Any:
        from pgmpy.models import DiscreteBayesianNetwork

        model = DiscreteBayesianNetwork(self.edges)
        model.add_nodes_from(list(self.states))
        model.add_cpds(*self.tables)
        model.check_model()
        return model


def object_model(network: ObjectNetwork) -> Any:
    """Category with a no/yes node per feature and a node of bands per measure."""
    builder = _Builder()
    _add_objects(builder, network)
    return builder.model()


def room_model(network: RoomNetwork) -> Any:
    """Room category and share seen, with a node of counts per evidence class."""
    builder = _Builder()
    _add_rooms(builder, network)
    return builder.model()


def contents_model(network: ContentsNetwork) -> Any:
    """Room category and share seen, with a found-or-not node and a number node per category."""
    builder = _Builder()
    _add_hidden(builder, network.rooms, network.prior, len(network.shares))
    _add_contents(builder, network)
    return builder.model()


def relationship_model(network: RelationshipNetwork) -> Any:
    """A seen and a predicted node per dual and per co-occurrence rule."""
    builder = _Builder()
    _add_relations(builder, network)
    return builder.model()


def write_bif(network: Network, path: Path) -> None:
    """Write all of them as one BIF file; rooms share their category and the share seen."""
    from pgmpy.readwrite import BIFWriter

    builder = _Builder()
    _add_objects(builder, network.objects)
    _add_rooms(builder, network.rooms)
    _add_contents(builder, network.contents_network)
    _add_relations(builder, network.relations)
    BIFWriter(builder.model()).write(str(path))


def _add_objects(builder: _Builder, network: ObjectNetwork) -> None:
    builder.add(CATEGORY, list(network.categories), network.prior[:, None], [])
    for name, column in network.features.items():
        builder.add(name, NO_YES, _no_yes(column), [CATEGORY])
    for name, table in network.measures.items():
        builder.add(name, band_states(len(table)), table, [CATEGORY])


def _add_rooms(builder: _Builder, network: RoomNetwork) -> None:
    _add_hidden(builder, network.rooms, network.prior, len(network.shares))
    for name, table in network.counts.items():
        builder.add(name, COUNT_STATES, table, [ROOM, SHARE])


def _add_hidden(builder: _Builder, rooms: tuple[str, ...], prior: Array, shares: int) -> None:
    builder.add(ROOM, list(rooms), prior[:, None], [])
    builder.add(SHARE, band_states(shares), np.full((shares, 1), 1 / shares), [])


def _add_contents(builder: _Builder, network: ContentsNetwork) -> None:
    """A noisy-OR as a chain of ORs: `ByRoom`, then a node per cause, the last is `InRoom`.

    So a category with forty causes has forty tables of eight numbers, not one of 2^41.
    """
    number = number_table(network.number)
    for i, name in sorted(enumerate(network.categories), key=_rarer_first(network)):
        causes = [c for c in network.causes if c.effect == i]
        links = [f"{name}By{network.categories[c.source]}" for c in causes[:-1]]
        chain = [f"{name}ByRoom", *links, f"{name}InRoom"] if causes else [f"{name}InRoom"]
        builder.add(
            chain[0], NO_YES, _no_yes(-np.expm1(-network.by_room[i]).ravel()), [ROOM, SHARE]
        )
        for before, cause, here in zip(chain, causes, chain[1:], strict=False):
            by_it = -np.expm1(-cause.hazard)
            table = _no_yes(np.array([0.0, by_it, 1.0, 1.0]))
            builder.add(here, NO_YES, table, [before, f"{network.categories[cause.source]}InRoom"])
        none = np.eye(len(NUMBER_STATES))[0][:, None].repeat(len(network.rooms), axis=1)
        some = np.vstack([np.zeros((1, len(network.rooms))), number[:, i]])
        table = np.hstack([none, some])
        builder.add(f"{name}Number", NUMBER_STATES, table, [f"{name}InRoom", ROOM])


def _rarer_first(network: ContentsNetwork) -> Callable[[tuple[int, str]], tuple[int, int]]:
    """Order in which every cause comes before its effects."""
    depth = [0] * len(network.categories)
    for _ in network.categories:
        deeper = list(depth)
        for cause in network.causes:
            deeper[cause.effect] = max(deeper[cause.effect], depth[cause.source] + 1)
        if deeper == depth:
            break
        depth = deeper
    return lambda item: (depth[item[0]], item[0])


def _add_relations(builder: _Builder, network: RelationshipNetwork) -> None:
    for name, strength in network.duals.items():
        builder.add(f"{name}Seen", NO_YES, np.array([[0.5], [0.5]]), [])
        builder.add(f"{name}There", NO_YES, _no_yes(np.array([0.0, strength])), [f"{name}Seen"])
    count = len(network.categories)
    for name, column in network.rules.items():
        even = np.full((count, 1), 1 / count)
        builder.add(f"{name}Anchor", list(network.categories), even, [])
        builder.add(f"{name}There", NO_YES, _no_yes(column), [f"{name}Anchor"])


def band_states(count: int) -> list[str]:
    """Names of the states of a node of bands."""
    return [f"band{i}" for i in range(count)]


COUNT_STATES = [
    f"from{first}" if last is None else f"from{first}to{last}" for first, last in COUNT_BINS
]

NUMBER_STATES = ["none", *(f"from{first}" for first in NUMBER_STARTS)]


def _no_yes(probability: Array) -> Array:
    return np.vstack([1.0 - probability, probability])
