"""How much later a visit is than the one before it, where its own clock may not tell.

A recording's stamps are seconds of whatever clock its robot has: the wall's, or one that starts
with the robot. A map's clock is that of its first visit, and later visits follow on it.
"""

from __future__ import annotations

WALL_CLOCK_FROM_S = 946_684_800.0
"""Midnight of 1 January 2000 in seconds since 1970: no robot has been up for thirty years."""
HOURS_BETWEEN = 24.0
"""What is taken where nothing tells: things are moved from day to day."""
SECONDS_PER_HOUR = 3600.0

NOTE = (
    "the stamps don't tell how long after the last visit this one was: a day is taken; "
    "--hours-later says how long"
)


def clock_offset(
    last_stamp: float, first_stamp: float, hours_later: float | None
) -> tuple[float, str | None]:
    """What to add to a later visit's stamps (s), and a note where that had to be assumed.

    - `last_stamp`: s, the map's clock, of the last view so far; `first_stamp`: s, of the visit's.
    - `hours_later`: what the user says. Else stamps that both are the wall's clock tell it, and
      where they don't, `HOURS_BETWEEN` is taken.

    >>> clock_offset(1_700_000_000.0, 1_700_090_000.0, None)
    (0.0, None)
    >>> clock_offset(90.0, 0.0, 2.0)
    (7290.0, None)
    """
    if hours_later is not None:
        return last_stamp + hours_later * SECONDS_PER_HOUR - first_stamp, None
    if last_stamp >= WALL_CLOCK_FROM_S and first_stamp > last_stamp:
        return 0.0, None
    return last_stamp + HOURS_BETWEEN * SECONDS_PER_HOUR - first_stamp, NOTE
