"""The paper's task: fetch a thing. Where to look first, how far it is, and why there.

usage: python examples/search_task.py MAP THING FROM      FROM: x,y (m), a node's id, or a room
"""

from __future__ import annotations

import sys

from afkb.asking import open_map
from afkb_mapping.api import search


def main(folder: str, thing: str, start: str) -> None:
    """Print the places in the order of least expected way, with what may be at each."""
    found = search(folder, start, thing)
    for place, metres in zip(found.places, found.metres, strict=True):
        x, y = place.xy
        print(f"after {metres:.1f} m, at ({x:.2f}, {y:.2f}): {place.probability:.2f}")
        for chance in place.found[:2]:
            print(f"    {chance.reason}")
    for best in open_map(folder).find(thing)[:1]:
        print(f"likeliest of all: {best.node} ({best.probability:.2f}), {best.reason}")


if __name__ == "__main__":
    main(*sys.argv[1:4])
