"""The three networks as pgmpy models: the tests' oracle, and what is written as BIF."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from afkb.inference.bands import Array
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


def relationship_model(network: RelationshipNetwork) -> Any:
    """A seen and a predicted node per dual and per co-occurrence rule."""
    builder = _Builder()
    _add_relations(builder, network)
    return builder.model()


def write_bif(network: Network, path: Path) -> None:
    """Write all three, side by side, as one BIF file."""
    from pgmpy.readwrite import BIFWriter

    builder = _Builder()
    _add_objects(builder, network.objects)
    _add_rooms(builder, network.rooms)
    _add_relations(builder, network.relations)
    BIFWriter(builder.model()).write(str(path))


def _add_objects(builder: _Builder, network: ObjectNetwork) -> None:
    builder.add(CATEGORY, list(network.categories), network.prior[:, None], [])
    for name, column in network.features.items():
        builder.add(name, NO_YES, _no_yes(column), [CATEGORY])
    for name, table in network.measures.items():
        builder.add(name, band_states(len(table)), table, [CATEGORY])


def _add_rooms(builder: _Builder, network: RoomNetwork) -> None:
    shares = len(network.shares)
    builder.add(ROOM, list(network.rooms), network.prior[:, None], [])
    builder.add(SHARE, band_states(shares), np.full((shares, 1), 1 / shares), [])
    for name, table in network.counts.items():
        builder.add(name, COUNT_STATES, table, [ROOM, SHARE])


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


def _no_yes(probability: Array) -> Array:
    return np.vstack([1.0 - probability, probability])
