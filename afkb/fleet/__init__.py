"""Maps of many robots in one SPARQL 1.1 server: a named graph each, whole or not there.

>>> from afkb.fleet import push
"""

from afkb.fleet.catalogue import KeptMap, kept_maps, remove
from afkb.fleet.keeper import Keeper
from afkb.fleet.names import named
from afkb.fleet.pushing import Pushed, PushState, push
from afkb.fleet.server import Server
from afkb.store.vocabulary import map_graph

__all__ = [
    "Keeper",
    "KeptMap",
    "PushState",
    "Pushed",
    "Server",
    "kept_maps",
    "map_graph",
    "named",
    "push",
    "remove",
]
