"""A ROS bag of your own, ROS 1 or 2, without ROS: map it, tell its rooms, ask what is where.

usage: python examples/own_ros_bag.py BAG MAP [key=value ...]

What follows are options of the bag's source, such as depth_topic=/camera/depth/image_rect_raw
or odom_frame=map.
"""

from __future__ import annotations

import sys

from afkb_mapping.api import map_recording
from afkb_mapping.source_options import options_of

THINGS = """
SELECT ?room (COUNT(?thing) AS ?things) WHERE {
  ?thing a afn:ObservedEntity ; afn:inRoom ?room .
} GROUP BY ?room ORDER BY ?room
"""


def main(bag: str, out: str, *words: str) -> None:
    """Map the bag; print each room with what it is for and how many things were seen in it."""
    found = map_recording(bag, out, options=options_of(words))
    for room in found.rooms():
        purpose, p = max(room["belief"].items(), key=lambda item: item[1])
        print(f"{room['id']}: {room['area']:.1f} m², {purpose} ({p:.2f})")
    for row in found.ask(THINGS):
        print(f"{row['room']}: {row['things']} things")


if __name__ == "__main__":
    main(*sys.argv[1:])
