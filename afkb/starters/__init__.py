"""Starters: files to begin an extension of the ontology with, which pass the check as they are."""

from afkb.starters.writing import Kind, write_starter

__all__ = ["Kind", "write_starter"]
