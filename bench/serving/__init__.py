"""What `afkb serve` bears, and how quickly it answers."""
