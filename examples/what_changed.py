"""What changed between two visits, room by room.

usage: python examples/what_changed.py MAP_BEFORE MAP_AFTER
"""

from __future__ import annotations

import sys
from collections import defaultdict

from afkb_mapping.api import changes


def main(before: str, after: str) -> None:
    """Print what moved, vanished and appeared, by the room that it is or was in."""
    found = changes(before, after)
    told = defaultdict(list)
    for was, now in found.moved:
        told[now["room"]].append(f"{now['id']} moved from ({was['x']:.2f}, {was['y']:.2f})")
    for node in found.vanished:
        told[node["room"]].append(f"{node['id']} vanished")
    for node in found.appeared:
        told[node["room"]].append(f"{node['id']} appeared")
    for room, lines in sorted(told.items(), key=lambda item: str(item[0])):
        print(room or "in no room")
        for line in lines:
            print(f"    {line}")
    print(f"{len(found.unchanged)} things as before, {len(found.unknown)} not looked at")


if __name__ == "__main__":
    main(*sys.argv[1:3])
