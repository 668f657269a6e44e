"""Mapper: a plain topological map of what was seen, without predictions."""
