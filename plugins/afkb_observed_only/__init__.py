"""Mapper: a plain topological map of what was seen, without predictions."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from afkb.plugins import hookimpl

if TYPE_CHECKING:
    from afkb.knowledge import AfNet
    from afkb.plugins.protocols import Mapper, MapperFactory


@dataclass(frozen=True, slots=True)
class ObservedOnlyFactory:
    """Makes mappers that keep what was seen and nothing else; `--rule` has no effect on them."""

    knowledge_base: AfNet
    name: str = "observed-only"

    def __call__(self, rule: str) -> Mapper:
        """A fresh mapper."""
        from afkb.inference import network_of
        from afkb_observed_only.mapper import ObservedOnlyMapper

        return ObservedOnlyMapper(network_of(self.knowledge_base))


@hookimpl
def afkb_mappers(knowledge_base: AfNet) -> Iterable[MapperFactory]:
    """Return the mapper without predictions."""
    return [ObservedOnlyFactory(knowledge_base)]
