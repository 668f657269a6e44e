"""Routes on a stored map: where a robot can drive, and in which order it looks for a thing."""
