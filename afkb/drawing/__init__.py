"""How a map is shown: its plan as SVG, what is known of its nodes, and the page's scripts."""

from afkb.drawing.assets import asset, asset_names, inline_script, inline_style, part
from afkb.drawing.drawing import Drawing, drawing_of
from afkb.drawing.plan import plan
from afkb.drawing.stored import drawing_of_stored

__all__ = [
    "Drawing",
    "asset",
    "asset_names",
    "drawing_of",
    "drawing_of_stored",
    "inline_script",
    "inline_style",
    "part",
    "plan",
]
