"""How well maps are made and used."""
