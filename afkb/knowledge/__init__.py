"""AfNet/AfRob: affordance features, categories, duals, co-occurrences and rooms, from OWL."""

from afkb.knowledge.base import AfNet
from afkb.knowledge.model import (
    Afbit,
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
from afkb.knowledge.stated_figures import ObjectInRoom, ObjectOnSupport, ObjectWithObject
from afkb.ontology.bundled import bundled_ontology
from afkb.ontology.names import AFN, COUNTED, SOMETHING_ELSE, UNKNOWN_ROOM

__all__ = [
    "AFN",
    "COUNTED",
    "SOMETHING_ELSE",
    "UNKNOWN_ROOM",
    "AfNet",
    "Afbit",
    "Category",
    "CoOccurrence",
    "Dual",
    "EvidenceClass",
    "Feature",
    "ObjectInRoom",
    "ObjectOnSupport",
    "ObjectWithObject",
    "Relationship",
    "RoomCategory",
    "Scale",
    "Trapezoid",
    "bundled_ontology",
]
