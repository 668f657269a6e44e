"""Where a robot is in a map it has made before, without knowing where it was (paper §I, §II.E)."""
