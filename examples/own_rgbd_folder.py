"""Depth images of your own, and where the camera was: look at them, map them, ask for supports.

usage: python examples/own_rgbd_folder.py FOLDER MAP [key=value ...]

FOLDER is in TUM's layout (depth.txt, groundtruth.txt) or in that of 7-Scenes. What follows are
options of its source, such as intrinsics=525,525,319.5,239.5 or depth_scale=1000.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping

from afkb.flow import View
from afkb.plugins.host import PluginHost
from afkb_mapping.api import map_recording
from afkb_mapping.source_options import options_of

SUPPORTS = """
SELECT ?thing ?height WHERE {
  ?thing a afn:ObservedEntity ; afn:affords afn:SupportAbility ; afn:z ?height .
} ORDER BY ?height
"""


def look(folder: str, options: Mapping[str, str]) -> None:
    """Print what the first frames say, before an hour is spent on mapping them."""
    source = PluginHost().open_source(folder, options)
    print(f"{len(source)} frames", *getattr(source, "notes", ()), sep="\n")
    for frame in source.views(stop=3):
        if isinstance(frame, View) and frame.depth_m is not None:
            seen = frame.depth_m[frame.depth_m > 0]
            print(f"at {frame.stamp:.2f} s: {seen.min():.2f} to {seen.max():.2f} m")
        elif not isinstance(frame, View):
            print(f"left out: {frame.where}: {frame.why}")


def main(folder: str, out: str, *words: str) -> None:
    """Map the folder; print each support with its height above the floor."""
    options = options_of(words)
    look(folder, options)
    found = map_recording(folder, out, options=options)
    for row in found.ask(SUPPORTS):
        print(f"{row['thing']}: {row['height']:.2f} m high")


if __name__ == "__main__":
    main(*sys.argv[1:])
