"""AfNet/AfRob: affordance features, categories, duals, co-occurrences and rooms, from OWL."""

from afkb.knowledge.base import KnowledgeBase, bundled_ontology
from afkb.knowledge.model import (
    Category,
    CoOccurrence,
    Dual,
    EvidenceClass,
    Feature,
    Relationship,
    RoomCategory,
    Scale,
    Trapezoid,
)
from afkb.knowledge.names import AFN, SOMETHING_ELSE, UNKNOWN_ROOM

__all__ = [
    "AFN",
    "SOMETHING_ELSE",
    "UNKNOWN_ROOM",
    "Category",
    "CoOccurrence",
    "Dual",
    "EvidenceClass",
    "Feature",
    "KnowledgeBase",
    "Relationship",
    "RoomCategory",
    "Scale",
    "Trapezoid",
    "bundled_ontology",
]
