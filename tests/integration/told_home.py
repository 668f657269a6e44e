"""The bundled home's map as plain Python sees it: what its statements tell of each node."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

from pyoxigraph import NamedNode

from afkb.knowledge import AfNet
from afkb.store import Dataset, StoredMap
from afkb.store.named import named_query
from afkb.store.shapes import node_json, rooms_json

Row = tuple[str, ...]


@dataclass(frozen=True)
class Home:
    """A map, asked in SPARQL and read in plain Python."""

    stored: StoredMap
    everything: Dataset
    kb: AfNet

    def ask(self, name: str, **values: str) -> list[Row]:
        """The rows of a named query, by local names."""
        sparql = named_query(name).filled(values)
        rows = self.everything.ask(sparql).cells()
        return [tuple(cell.partition(":")[2] if ":" in cell else cell for cell in r) for r in rows]

    def column(self, name: str, column: int = 0, **values: str) -> list[str]:
        return [row[column] for row in self.ask(name, **values)]

    @cached_property
    def things(self) -> list[dict]:  # type: ignore[type-arg]
        return [self._exactly(node) for node in self.stored.instances("ObservedEntity")]

    def _exactly(self, node: NamedNode) -> dict:  # type: ignore[type-arg]
        """As `afkb info` tells it, with all categories, and unrounded."""
        exact = {
            key: self.stored.number(node, f"afn:{key}") for key in ("x", "y", "z", "existence")
        }
        belief = self.stored.belief(node, "category", "category")
        return node_json(self.stored, node, "ObservedEntity") | exact | {"category": belief}

    @cached_property
    def by_id(self) -> dict[str, dict]:  # type: ignore[type-arg]
        return {thing["id"]: thing for thing in self.things}

    @cached_property
    def purpose(self) -> dict[str, str]:
        return {r["id"]: max(r["belief"], key=r["belief"].get) for r in rooms_json(self.stored)}

    def ids(self, test: Callable[[dict], object]) -> set[str]:  # type: ignore[type-arg]
        return {thing["id"] for thing in self.things if test(thing)}

    def value(self, thing: dict | str, predicate: str) -> float:  # type: ignore[type-arg]
        name = thing if isinstance(thing, str) else thing["id"]
        return self.stored.number(self.node(name), predicate)

    def node(self, name: str) -> NamedNode:
        return NamedNode(self.stored.base + name)

    def told(self, thing: dict, predicate: str) -> list[str]:  # type: ignore[type-arg]
        return self.stored.names(self.node(thing["id"]), predicate)

    def of(self, kind: str, predicate: str) -> list[str]:
        return [
            name
            for node in self.stored.instances(kind)
            for name in self.stored.names(node, predicate)
        ]

    def likely(self, thing: dict) -> str:  # type: ignore[type-arg]
        return max(thing["category"], key=thing["category"].get)

    def is_one(self, thing: dict, *names: str) -> float:  # type: ignore[type-arg]
        return sum(
            p
            for category, p in thing["category"].items()
            if {*names} & {*self.kb.kinds_of(category)}
        )

    @property
    def dynamic(self) -> set[str]:
        return self.ids(lambda t: "Dynamic" in self.told(t, "afn:movability"))

    @property
    def kitchen(self) -> str:
        return next(room for room, purpose in self.purpose.items() if purpose == "Kitchen")
