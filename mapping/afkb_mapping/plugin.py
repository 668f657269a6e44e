"""Brings the built-in mapper and the commands that need geometry."""
