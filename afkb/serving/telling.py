"""Drawings of maps, and why their nodes are there, as JSON; beside the queries' processes."""

from __future__ import annotations

import json
from functools import cached_property

from afkb.errors import MapError
from afkb.knowledge import AfNet
from afkb.serving.channel import Head
from afkb.serving.errors import Refused
from afkb.serving.shelf import Shelf
from afkb.store import StoredMap
from afkb.store.made_with import knowledge_of


class Told:
    """What can be told of one map; what it was made with is read once."""

    def __init__(self, name: str, stored: StoredMap) -> None:
        self._name = name
        self._stored = stored

    def drawing(self) -> dict[str, object]:
        """See `afkb.drawing.drawing_of_stored`."""
        from afkb.drawing import drawing_of_stored

        return drawing_of_stored(self._stored) | {"name": self._name}

    def why(self, node: str) -> dict[str, object]:
        """What `afkb why --json` prints; `Refused` for a node that there is not."""
        from afkb.explaining import explain
        from afkb.explaining.shape import explanation_json

        try:
            return explanation_json(explain(self._stored, node, self._knowledge))
        except MapError as error:
            # Where the map lies on the server's disk is not the client's affair.
            told = str(error).replace(str(self._stored.folder), self._name)
            raise Refused(404, told) from error

    @cached_property
    def _knowledge(self) -> AfNet:
        return knowledge_of(self._stored)


class Teller:
    """Tells of every map on the shelf."""

    def __init__(self, shelf: Shelf) -> None:
        self._maps = {name: Told(name, stored) for name, stored in shelf.maps.items()}

    def tell(self, asked: Head) -> tuple[str, bytes]:
        """The drawing of `map`, or why its `node` is there: media type and content."""
        told = self._maps[asked["map"]]
        found = told.why(asked["node"]) if "node" in asked else told.drawing()
        return "application/json", json.dumps(found, allow_nan=False).encode()
