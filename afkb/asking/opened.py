"""One map, opened: what it holds, and the questions one can ask it."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from afkb.asking.values import Value, rows_of
from afkb.store import Dataset, QueryResult, StoredMap, load
from afkb.store.made_with import knowledge_of
from afkb.store.shapes import doorways_json, nodes_json, rooms_json
from afkb.store.vocabulary import MAP_NODES

if TYPE_CHECKING:
    from afkb.explaining import Explanation
    from afkb.finding import Region
    from afkb.knowledge import AfNet


def open_map(folder: Path | str, extensions: Sequence[Path | str] = ()) -> OpenMap:
    """Open the map in a folder that `afkb map` wrote.

    `extensions`: of the ontology, in place of those that the map was made with. `MapError` where
    the folder holds no map, or an extension that it was made with is gone.
    """
    return OpenMap(load(folder), tuple(map(Path, extensions)))


class OpenMap:
    """A map to ask from Python; nothing is read before it is asked for.

    Nodes and rooms come in the shapes of `afkb info --json` and `afkb rooms --json`
    (docs/reference.md): positions in the map frame, m and rad.
    """

    def __init__(self, stored: StoredMap, extensions: tuple[Path, ...] = ()) -> None:
        self.stored = stored
        self._extensions = extensions

    @property
    def folder(self) -> Path:
        """Where it lies on disk."""
        return self.stored.folder

    @cached_property
    def knowledge_base(self) -> AfNet:
        """The ontology, with the extensions that the map was made with."""
        return knowledge_of(self.stored, self._extensions)

    @cached_property
    def dataset(self) -> Dataset:
        """The map and the ontology, with what follows from both, for many queries."""
        return Dataset.load([self.stored], self.knowledge_base.files)

    def nodes(self, *kinds: str) -> list[dict[str, Any]]:
        """Its nodes, or those of kinds such as `ObservedEntity` and `DualPrediction`."""
        unknown = sorted(set(kinds) - set(MAP_NODES))
        if unknown:
            raise ValueError(f"no kind of node is called {unknown[0]!r}: {', '.join(MAP_NODES)}")
        return nodes_json(self.stored, kinds or MAP_NODES)

    def rooms(self) -> list[dict[str, Any]]:
        """Its rooms: `belief` over what each is for, `area` (m²), `polygon` ([[x, y], …], m)."""
        return rooms_json(self.stored)

    def doorways(self) -> list[dict[str, Any]]:
        """Its doorways, with the rooms that they join."""
        return doorways_json(self.stored)

    def ask(self, query: str) -> list[dict[str, Value]]:
        """Rows of Python values: of a SPARQL query, or of a named one such as `@room-beliefs`.

        `QueryError`, with line and column, where it can't be answered.
        """
        return rows_of(answer_of(self.dataset, query))

    def find(self, thing: str) -> list[Region]:
        """Where such a thing is or would be, the likeliest place first.

        `QueryError` where the ontology has no such kind; it names those that are meant perhaps.
        """
        from afkb.finding import Surroundings, category_named, regions

        category = category_named(thing, self.knowledge_base)
        return regions(category, Surroundings.of(self.stored), self.knowledge_base)

    def why(self, node: str) -> Explanation:
        """The chain behind a node: pixels, evidence, statements, probabilities."""
        from afkb.explaining import explain

        return explain(self.stored, node, self.knowledge_base)

    def __repr__(self) -> str:
        return f"OpenMap({str(self.folder)!r})"


def answer_of(dataset: Dataset, query: str) -> QueryResult:
    """The answer to a query, or to a named one (`@name`, `@name parameter=value …`)."""
    if not query.lstrip().startswith("@"):
        return dataset.ask(query)
    from afkb.store.named import check_known, named_query, read_values

    name, *words = query.split()
    asked, values = named_query(name), read_values(words)
    check_known(dataset.store, asked, values, dataset.prefixes["scene"])
    return dataset.ask(asked.filled(values))
