"""Predictors: affordance duals and co-occurrences, compiled from the ontology."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from afkb.plugins import hookimpl

if TYPE_CHECKING:
    from afkb.knowledge import AfNet
    from afkb.plugins.protocols import Predictor


@hookimpl
def afkb_predictors(knowledge_base: AfNet) -> Iterable[Predictor]:
    """The filtrations of order 1 and 2 (paper §II.D.ii, §II.D.iii)."""
    from afkb_filtrations.co_occurrence import CoOccurrencePredictor
    from afkb_filtrations.duals import DualPredictor

    return [DualPredictor(knowledge_base), CoOccurrencePredictor(knowledge_base)]
