"""The grid that routes are sought on: read by `afkb.store.stored_grid`."""

from afkb.store.stored_grid import StoredGrid, read_grid

__all__ = ["StoredGrid", "read_grid"]
