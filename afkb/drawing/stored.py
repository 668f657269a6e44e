"""The drawing of a map that is read back from its folder."""

from __future__ import annotations

from afkb.drawing.drawing import drawing_of
from afkb.drawing.facts import Json
from afkb.store import StoredMap
from afkb.store.stored_map import read_map


def drawing_of_stored(stored: StoredMap) -> Json:
    """All that the page of `afkb serve` needs of a map, as plain data.

    `name` of its folder, `base` of its nodes' IRIs, `svg`: the plan, `nodes` and `time` as in
    `Drawing`, `summary`, `notes`. Raises `MapError` where the folder can't be read as a map.
    """
    drawing = drawing_of(read_map(stored))
    return {
        "name": stored.folder.resolve().name,
        "base": stored.base,
        "svg": drawing.svg,
        "summary": drawing.summary,
        "notes": list(drawing.notes),
        **drawing.as_json(),
    }
