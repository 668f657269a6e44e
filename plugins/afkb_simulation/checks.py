"""What a world file must agree on beyond its single values."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from afkb.errors import SourceError
from afkb_simulation.world_file import ThingFile, WorldFile


def check_world(world: WorldFile, path: Path) -> None:
    """Raise `SourceError` where names clash or point nowhere."""
    waypoints = [w.name for w in world.tour.waypoints]
    _check_unique("rooms", (r.name for r in world.rooms), path)
    _check_unique("things", (t.name for t in world.things), path)
    _check_unique("tour.waypoints", waypoints, path)
    _check_doorways(world, path)
    by_name = {t.name: t for t in world.things}
    for thing in world.things:
        _check_carrier(thing, by_name, path)
        _check_presence(thing, waypoints, path)


def _check_unique(key: str, names: Iterable[str], path: Path) -> None:
    seen: set[str] = set()
    for name in names:
        if name in seen:
            raise SourceError(f"{path}: {key}: two are named {name!r}; rename one")
        seen.add(name)


def _check_doorways(world: WorldFile, path: Path) -> None:
    rooms = {r.name for r in world.rooms}
    for i, doorway in enumerate(world.doorways):
        key = f"{path}: doorways[{i}].between"
        for name in doorway.between:
            if name not in rooms:
                raise SourceError(f"{key}: no room {name!r}; rooms: {', '.join(sorted(rooms))}")
        if doorway.between[0] == doorway.between[1]:
            raise SourceError(f"{key}: names {name!r} twice; name the two rooms it joins")


def _check_carrier(thing: ThingFile, by_name: dict[str, ThingFile], path: Path) -> None:
    passed = [thing.name]
    while thing.on is not None:
        if thing.on not in by_name:
            raise SourceError(f"{path}: things ({thing.name}).on: no thing {thing.on!r}; add it")
        if thing.on in passed:
            raise SourceError(f"{path}: things ({thing.name}).on: stands on itself; mend the chain")
        thing = by_name[thing.on]
        passed.append(thing.name)


def _check_presence(thing: ThingFile, waypoints: list[str], path: Path) -> None:
    if thing.present is None:
        return
    key = f"{path}: things ({thing.name}).present"
    for name in (thing.present.from_, thing.present.until):
        if name is not None and name not in waypoints:
            raise SourceError(f"{key}: no waypoint {name!r}; waypoints: {', '.join(waypoints)}")
    first, last = thing.present.from_, thing.present.until
    if first and last and waypoints.index(first) > waypoints.index(last):
        raise SourceError(f"{key}: {last!r} comes before {first!r}; swap them")
