"""Maps one scenario and measures all that the paper tells of it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from afkb.errors import SourceError
from afkb.plugins.host import PluginHost
from afkb.store.stored_grid import read_grid
from afkb_mapping.run import Progress, make_map
from afkb_mapping.run_record import Settings
from afkb_paper.fetching import fetched
from afkb_paper.hidden import hidden_things
from afkb_paper.judged import Judged
from afkb_paper.moving import moved_things
from afkb_paper.panels import Camera
from afkb_paper.rooms import judged_rooms
from afkb_paper.rows import Outcome, Row, rows
from afkb_paper.scenarios import Scenario
from afkb_paper.sheet import sheet
from afkb_paper.steps import Steps


@dataclass(frozen=True, slots=True, eq=False)
class Reproduced:
    """A scenario's table; `folder` holds its map, `sheet` its pictures."""

    scenario: Scenario
    uri: str
    folder: Path
    sheet: Path
    rows: Sequence[Row]

    @property
    def command(self) -> str:
        """What maps it alone."""
        return f"afkb map {self.uri} --out {self.folder}"


def reproduced(
    host: PluginHost,
    scenario: Scenario,
    uri: str,
    out: Path,
    progress: Callable[[Progress], None] = lambda _: None,
) -> Reproduced:
    """Map a scenario into `out/scenario-N`, judge it, and draw its sheet beside it.

    Raises `SourceError` where the recording can't be used or nothing is known to be true of it.
    """
    truth = host.truth(uri)
    if truth is None:
        raise SourceError(f"{uri}: no truth to judge its map by; put truth.json beside it")
    folder = out / f"scenario-{scenario.number}"
    made = make_map(host, Settings(uri=uri, out=folder), progress)
    if made.interrupted is not None:
        raise KeyboardInterrupt  # Its map holds what was seen; half a scenario is not judged.
    steps = Steps.of(folder, host)
    outcome = measured(Judged.of(made.topological_map, truth), folder, steps)
    table = list(rows(scenario.paper, outcome))
    title = f"Scenario {scenario.number}: {scenario.title}"
    drawn = out / f"scenario-{scenario.number}.html"
    camera = Camera.of(host, uri)
    drawn.write_text(sheet(title, uri, table, outcome, steps, camera), encoding="utf-8")
    return Reproduced(scenario, uri, folder, drawn, table)


def measured(judged: Judged, folder: Path, steps: Steps) -> Outcome:
    """All measures of a map in a folder, made of a recording whose truth is known."""
    return Outcome(
        judged,
        judged_rooms(judged.found, judged.truth),
        hidden_things(judged, steps, read_grid(folder)),
        list(moved_things(judged, steps)),
        fetched(judged, folder, steps.host.knowledge_base),
    )
