"""The scene store: a map as RDF, its folder on disk, and SPARQL over it.

>>> from afkb.store import load, query
"""

from afkb.store.folder import check_out
from afkb.store.results import QueryResult
from afkb.store.sparql import Dataset, query
from afkb.store.stored import StoredMap, load
from afkb.store.write import write_map

__all__ = ["Dataset", "QueryResult", "StoredMap", "check_out", "load", "query", "write_map"]
