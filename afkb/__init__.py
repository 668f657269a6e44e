"""Topological affordance maps: knowledge, inference, plugin host, scene store, command line.

This package computes no geometry; `afkb_mapping` does, and plugins bring everything else.
"""

__version__ = "0.1.0"
