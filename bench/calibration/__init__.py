"""How often detectors are right when they say so, and the tables that make them mean it."""
