"""Doorways: what views told of them, and what the grid bears out."""
