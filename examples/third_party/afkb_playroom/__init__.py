"""A sample plugin package: a detector, a mapper and an ontology extension.

Everything heavy is imported when it is used, so that `afkb --help` stays quick.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from afkb.plugins import hookimpl

if TYPE_CHECKING:
    from afkb.knowledge import AfNet
    from afkb.plugins.protocols import Detector, Mapper, MapperFactory


@hookimpl
def afkb_detectors() -> Iterable[Detector]:
    """Return the detector of balls."""
    from afkb_playroom.balls import BallDetector

    return [BallDetector()]


@dataclass(frozen=True, slots=True)
class SkeletonFactory:
    """Makes mappers that keep places, supports and what rolls; `--rule` has no effect on them."""

    knowledge_base: AfNet
    name: str = "skeleton"

    def __call__(self, rule: str) -> Mapper:
        """A fresh mapper."""
        from afkb.inference import Network
        from afkb_playroom.skeleton import SkeletonMapper

        return SkeletonMapper(Network.compile(self.knowledge_base))


@hookimpl
def afkb_mappers(knowledge_base: AfNet) -> Iterable[MapperFactory]:
    """Return the small mapper; a hook may leave out the arguments it does not need."""
    return [SkeletonFactory(knowledge_base)]


@hookimpl
def afkb_ontologies() -> Iterable[Path]:
    """Return the words for a playroom."""
    return [Path(__file__).parent / "playroom.owl"]
