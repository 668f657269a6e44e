"""How well the network infers what things are, what else is there, and what rooms are for."""
