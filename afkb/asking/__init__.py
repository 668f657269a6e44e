"""Maps opened from Python: their nodes and rooms, SPARQL, where a thing is, and why.

>>> from afkb.asking import open_map, open_maps
"""

from afkb.asking.fleet import Fleet, open_maps
from afkb.asking.opened import OpenMap, open_map

__all__ = ["Fleet", "OpenMap", "open_map", "open_maps"]
