"""The occupancy grid, and what can be read from it."""
