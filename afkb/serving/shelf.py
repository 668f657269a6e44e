"""The maps that are served, loaded once: by name, and all together as one dataset."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import unquote

from pyoxigraph import NamedNode, Store

from afkb.errors import QueryError
from afkb.store import StoredMap, load
from afkb.store.sparql import dataset, graph_name
from afkb.store.vocabulary import MAP_NODES, PREFIXES

_MAP = "urn:afkb:map:"


@dataclass(frozen=True)
class Shelf:
    """Maps by their name in addresses, their graphs, and the dataset that queries ask."""

    maps: dict[str, StoredMap]
    graphs: dict[str, str]
    store: Store

    @classmethod
    def open(cls, folders: Sequence[Path], ontology: Sequence[Path]) -> Shelf:
        """Load everything; `MapError` or `KnowledgeError` where something can't be read."""
        stored = [load(folder) for folder in folders]
        taken: set[str] = set()
        graphs = [graph_name(one.folder, taken) for one in stored]
        names = [unquote(graph.removeprefix(_MAP)) for graph in graphs]
        store = dataset(stored, ontology)
        return cls(
            dict(zip(names, stored, strict=True)), dict(zip(names, graphs, strict=True)), store
        )

    @property
    def prefixes(self) -> dict[str, str]:
        """What queries need not declare; `scene:` is the first map's."""
        first = next(iter(self.maps.values()), None)
        return dict(PREFIXES) | ({"scene": first.base} if first else {})

    def listed(self) -> list[dict[str, object]]:
        """The maps as `/api/maps` shows them."""
        return [
            {
                "name": name,
                "graph": self.graphs[name],
                "nodes": sum(stored.kinds[kind] for kind in MAP_NODES),
            }
            for name, stored in self.maps.items()
        ]

    def graph_names(self) -> list[str]:
        """Every named graph of the dataset, in order."""
        found = (g.value for g in self.store.named_graphs() if isinstance(g, NamedNode))
        return sorted(found)

    def known(self, graphs: Sequence[str]) -> list[NamedNode]:
        """Graphs by name; `QueryError` for one that is not served: nothing is ever fetched."""
        served = self.graph_names()
        for name in graphs:
            if name not in served:
                raise QueryError(f"no graph <{name[:200]}> here; there are: {', '.join(served)}")
        return [NamedNode(name) for name in graphs]
