"""Learning from a user's own homes: a map's rooms as a table to correct, and what follows."""

from afkb.learning.lessons import Lesson, Lessons, learnt
from afkb.learning.table import COLUMNS, rooms_of, table_text

__all__ = ["COLUMNS", "Lesson", "Lessons", "learnt", "rooms_of", "table_text"]
