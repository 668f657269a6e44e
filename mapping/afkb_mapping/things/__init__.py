"""Things seen, and what is known of each: one node a thing."""
