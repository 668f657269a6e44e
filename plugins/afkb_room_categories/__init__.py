"""Room classifier: what rooms are for by affordances and by the categories of recognised things."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from afkb.plugins import hookimpl

if TYPE_CHECKING:
    from afkb.knowledge import AfNet
    from afkb.plugins.protocols import RoomClassifier


@hookimpl
def afkb_room_classifiers(knowledge_base: AfNet) -> Iterable[RoomClassifier]:
    """Return the classifier that asks for categories, too."""
    from afkb_room_categories.classifier import CategoryClassifier

    return [CategoryClassifier(knowledge_base)]
