"""Several maps, opened together and asked as one."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from pathlib import Path

from afkb.asking.opened import OpenMap, answer_of, open_map
from afkb.asking.values import Value, rows_of
from afkb.store import Dataset


def open_maps(*folders: Path | str, extensions: Sequence[Path | str] = ()) -> Fleet:
    """Open several maps; errors as of `open_map`, and `ValueError` where none is named."""
    if not folders:
        raise ValueError("open_maps needs the folder of a map, or of several")
    return Fleet([open_map(folder, extensions) for folder in folders])


class Fleet:
    """Maps with the ontology in one dataset; each is a named graph (`GRAPH ?map { … }`)."""

    def __init__(self, maps: Sequence[OpenMap]) -> None:
        self.maps = tuple(maps)

    @cached_property
    def dataset(self) -> Dataset:
        """All maps, the ontology and every extension that one of them was made with."""
        files = dict.fromkeys(file for m in self.maps for file in m.knowledge_base.files)
        return Dataset.load([m.stored for m in self.maps], files)

    @property
    def graphs(self) -> dict[str, OpenMap]:
        """The named graph of each map."""
        return dict(zip(self.dataset.graphs, self.maps, strict=True))

    def ask(self, query: str) -> list[dict[str, Value]]:
        """Rows of Python values, as of `OpenMap.ask`, over all maps together."""
        return rows_of(answer_of(self.dataset, query))
