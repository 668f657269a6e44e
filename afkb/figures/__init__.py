"""How likely things are in rooms, beside each other and on supports, counted in real homes."""

from afkb.figures.counting import count_rooms
from afkb.figures.counts import Counts
from afkb.figures.figure import Figure, InRoom, OnSupport, Rate, Together
from afkb.figures.figures import Figures
from afkb.figures.files import read_counts, write_counts
from afkb.figures.names import Names
from afkb.figures.reading import Shape
from afkb.figures.refitting import refitted
from afkb.figures.simulated import read_simulated

__all__ = [
    "Counts",
    "Figure",
    "Figures",
    "InRoom",
    "Names",
    "OnSupport",
    "Rate",
    "Shape",
    "Together",
    "count_rooms",
    "read_counts",
    "read_simulated",
    "refitted",
    "write_counts",
]
