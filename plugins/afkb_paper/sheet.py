"""A scenario's sheet: one HTML file with a row of pictures a step, in the paper's layout."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from html import escape
from pathlib import Path
from string import Template

import numpy as np
from numpy.typing import NDArray

from afkb.drawing.words import best
from afkb.flow import NodeKind, TopologicalMap
from afkb_paper.fetching import Fetched
from afkb_paper.hidden import Hidden
from afkb_paper.panels import Camera, Frame, graph_panel, grid_panel, ways_panel
from afkb_paper.rows import Outcome, Row
from afkb_paper.steps import Steps, moments

NOTHING_SEEN = "<p>no depth image here</p>"
_PAGE = Path(__file__).with_name("sheet.html")


def sheet(
    title: str, uri: str, table: Sequence[Row], outcome: Outcome, steps: Steps, camera: Camera
) -> str:
    """The sheet's HTML; it needs no other file, and is the same for the same map."""
    found = outcome.judged.found
    frame = Frame.around(found)
    return Template(_PAGE.read_text(encoding="utf-8")).substitute(
        title=escape(title),
        source=escape(uri),
        table="\n".join(_table(table)),
        steps="\n".join(_steps(found, steps, camera, frame)),
        ways="\n".join(_ways(outcome, frame)),
    )


def _table(rows: Sequence[Row]) -> Iterator[str]:
    for row in rows:
        cells = "".join(f"<td>{escape(text)}</td>" for text in (row.paper, row.ours, row.how))
        yield f'<tr><th scope="row">{escape(row.what)}</th>{cells}</tr>'


def _steps(found: TopologicalMap, steps: Steps, camera: Camera, frame: Frame) -> Iterator[str]:
    drawn = moments(found)
    for number, (place, moment) in enumerate(drawn, start=1):
        then = steps.until(moment) if number < len(drawn) else found
        seen = steps.view_at(place, place.stamp, moment)
        picture = camera.picture(seen.view.index, seen.T_map_base) if seen else NOTHING_SEEN
        panels = (picture, graph_panel(then, frame), grid_panel(then, frame))
        yield _figure(f"{number}. {_told(then)}", panels)


def _told(then: TopologicalMap) -> str:
    """What the map holds at a step, in a sentence."""
    kinds = [entity.kind for entity in then.entities]
    seen = kinds.count(NodeKind.OBSERVED)
    rooms = [best(room.belief, 1)[0] for room in then.rooms if room.visited]
    named = ", ".join(f"{name} {p:.2f}" for name, p in rooms)
    expected = len(kinds) - seen
    counted = ((len(then.places), "place"), (seen, "thing"))
    places, things = (f"{n} {what}{'' if n == 1 else 's'}" for n, what in counted)
    text = f"{places}, {things} seen, {expected} expected"
    if then.closures:
        text += f", {len(then.closures)} come true"
    return f"{text}. Rooms: {named or 'none yet'}."


def _ways(outcome: Outcome, frame: Frame) -> Iterator[str]:
    for hidden in outcome.hidden:
        if hidden.blind.hits:
            yield _past(hidden)
    if isinstance(outcome.fetched, Fetched) and outcome.fetched.length_m is not None:
        way: list[tuple[str, NDArray[np.float64]]] = [("expecting", outcome.fetched.path)]
        panel = ways_panel(outcome.judged.found, frame, way)
        where = f"in the {outcome.fetched.room}, after {outcome.fetched.length_m:.1f} m"
        yield _figure(f"A mug is sought from the hall and found {where}.", (panel,))


def _past(hidden: Hidden) -> str:
    """The way that leads worst through a hidden thing, and the one that the map leads."""
    worst = hidden.worst
    both = (("blind", hidden.blind.ways[worst]), ("expecting", hidden.expecting.ways[worst]))
    ways = [(kind, way) for kind, way in both if way is not None]
    true = np.array(hidden.outline.exterior.coords)
    frame = Frame.of([true, *(way for _, way in ways)])
    panel = ways_panel(hidden.map_then, frame, ways, true)
    text = (
        f"{hidden.thing.name} is hidden, but expected with p = {hidden.probability:.2f}. Pink: "
        "where it truly stands. Red, dashed: the way without what is expected; green: with it."
    )
    return _figure(text, (panel,))


def _figure(caption: str, panels: Sequence[str]) -> str:
    inside = "".join(f"<div>{panel}</div>" for panel in panels if panel)
    return f"<figure><figcaption>{escape(caption)}</figcaption>{inside}</figure>"
