"""What is kept of each view, so that a map can be built again, continued, and corrected."""
