"""A whole map read back from its folder: `afkb.store.stored_map`, under its public name."""

from afkb.store.stored_map import TRAJECTORY_FILE, read_map, run_of

__all__ = ["TRAJECTORY_FILE", "read_map", "run_of"]
