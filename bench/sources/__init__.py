"""How recordings are read: how fast beside others, and whether formats agree."""
