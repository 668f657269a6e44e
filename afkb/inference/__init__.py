"""Posteriors from the ontology: what things are, what else is there, what rooms are for."""

from afkb.inference.joint import SeenThing
from afkb.inference.network import Network, network_of

__all__ = ["Network", "SeenThing", "network_of"]
