"""The maps that are served, loaded once: by name, and all together as one dataset."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import unquote

from pyoxigraph import NamedNode

from afkb.store import StoredMap, load
from afkb.store.sparql import Dataset
from afkb.store.vocabulary import MAP_NODES

_MAP = "urn:afkb:map:"


@dataclass(frozen=True)
class Shelf:
    """Maps by their name in addresses, and the dataset that queries ask."""

    maps: dict[str, StoredMap]
    dataset: Dataset

    @classmethod
    def open(cls, folders: Sequence[Path], ontology: Sequence[Path]) -> Shelf:
        """Load everything; `MapError` or `KnowledgeError` where something can't be read."""
        stored = [load(folder) for folder in folders]
        dataset = Dataset.load(stored, ontology)
        names = [unquote(graph.removeprefix(_MAP)) for graph in dataset.graphs]
        return cls(dict(zip(names, stored, strict=True)), dataset)

    def listed(self) -> list[dict[str, object]]:
        """The maps as `/api/maps` shows them."""
        return [
            {"name": name, "graph": graph, "nodes": sum(stored.kinds[kind] for kind in MAP_NODES)}
            for graph, (name, stored) in zip(self.dataset.graphs, self.maps.items(), strict=True)
        ]

    def graph_names(self) -> list[str]:
        """Every named graph of the dataset, in order."""
        found = self.dataset.store.named_graphs()
        return sorted(graph.value for graph in found if isinstance(graph, NamedNode))
