"""Rooms: what belongs to each, what it is for, and how they are joined."""
