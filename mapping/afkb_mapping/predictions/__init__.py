"""Things that are predicted and not seen yet: where they may be, and how sure that is."""
