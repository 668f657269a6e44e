"""Where a thing of some kind is or would be, and how it can be grasped: read from a map's RDF."""

from afkb.finding.names import category_named
from afkb.finding.regions import Region, regions, somewhere
from afkb.finding.surroundings import Node, RoomNode, Surroundings

__all__ = [
    "Node",
    "Region",
    "RoomNode",
    "Surroundings",
    "category_named",
    "regions",
    "somewhere",
]
