"""Room classifier: what rooms are for by doors and walls alone, the paper's baseline [11]."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from afkb.plugins import hookimpl

if TYPE_CHECKING:
    from afkb.knowledge import AfNet
    from afkb.plugins.protocols import RoomClassifier


@hookimpl
def afkb_room_classifiers(knowledge_base: AfNet) -> Iterable[RoomClassifier]:
    """Return the classifier by doors and walls."""
    from afkb_room_shape.classifier import ShapeClassifier

    return [ShapeClassifier(knowledge_base)]
