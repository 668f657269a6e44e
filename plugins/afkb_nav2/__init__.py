"""Exporter: occupancy grid for nav2's map_server."""
