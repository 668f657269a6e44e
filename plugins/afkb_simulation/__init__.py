"""Source: a simulated world, ray-cast."""
