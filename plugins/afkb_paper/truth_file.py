"""`truth.json`: what is so in a recorded home, as those who made the recording wrote it down.

`views`: `stamp` (s), `x`, `y` (m), `yaw` (rad) of the base and `room`. `things`: `name`,
`category`, `room`, `min` and `max` corners (m) of an upright box. Rooms are named by their
category, a number behind it: `kitchen_0`. Things that were scanned for a catalogue carry its number
before their category: `025_mug`, `065-f_cups`.
"""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any

from afkb.errors import SourceError
from afkb.figures import Names
from afkb.flow import OrientedBox, TrueThing, TrueView, Truth
from afkb.ontology.bundled import bundled_ontology

FILE = "truth.json"
_CATALOGUE = re.compile(r"^\d+(-[a-z])?_")


def truth_beside(uri: str) -> Truth | None:
    """The truth in the folder of a recording, or beside it; None where there is no such file.

    Raises `SourceError` where it can't be read.
    """
    folder = Path(uri)
    paths = [p for p in (folder / FILE, folder.parent / FILE) if p.is_file()]
    if "://" in uri or not folder.exists() or not paths:
        return None
    try:
        return truth_of(json.loads(paths[0].read_text(encoding="utf-8")))
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
        raise SourceError(
            f"{paths[0]}: no truth of a home: {error!r}; mend or remove it"
        ) from error


def truth_of(told: Mapping[str, Any]) -> Truth:
    """The truth that the file's content tells."""
    views = tuple(
        TrueView(float(v["stamp"]), float(v["x"]), float(v["y"]), float(v["yaw"]), v["room"])
        for v in told["views"]
    )
    rooms = {v.room for v in views if v.room is not None}
    things = tuple(_thing(thing) for thing in told["things"])
    return Truth(views, things, {name: room_category(name) or "" for name in sorted(rooms)})


def room_category(name: str) -> str | None:
    """The ontology's name for what a room is called, number or not; None where it has none."""
    return _names().rooms.find("homes", name.rstrip("0123456789_"))


def _thing(told: Mapping[str, Any]) -> TrueThing:
    low, high = told["min"], told["max"]
    x, y, z = ((float(a) + float(b)) / 2 for a, b in zip(low, high, strict=True))
    sx, sy, sz = (float(b) - float(a) for a, b in zip(low, high, strict=True))
    called = _CATALOGUE.sub("", str(told["category"]))
    category = _names().categories.find("homes", called) or called
    return TrueThing(told["name"], category, OrientedBox((x, y, z), (sx, sy, sz)), told.get("room"))


@cache
def _names() -> Names:
    return Names.load(bundled_ontology().parent / "tables")
