"""Making maps from Python: what `afkb map`, `route` and `diff` do, as functions.

>>> from afkb_mapping.api import map_recording, update_map, route, search, changes
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from afkb.asking import OpenMap, open_map
from afkb.plugins.brought import bring
from afkb.plugins.host import PluginHost
from afkb_mapping.run_record import Settings

if TYPE_CHECKING:
    from afkb.knowledge import AfNet
    from afkb_mapping.routes.ends import End
    from afkb_mapping.routes.planner import Route
    from afkb_mapping.routes.route_map import RouteMap
    from afkb_mapping.routes.search import Search
    from afkb_mapping.run import Progress
    from afkb_mapping.visits.diff import Difference


def map_recording(
    source: str | Path,
    out: str | Path,
    *,
    add: Sequence[object] = (),
    extensions: Sequence[str | Path] = (),
    options: Mapping[str, str] | None = None,
    progress: Callable[[Progress], None] = lambda _: None,
    **settings: Any,
) -> OpenMap:
    """Map a recording into a folder and open the map (paper, Algorithm 1).

    - `add`: detectors, predictors, room classifiers or whole plugins of yours, used beside those
      that are installed.
    - `extensions`: files that extend the ontology; `options`: of the source, as `--option` has it.
    - `settings`: further fields of `afkb_mapping.run_record.Settings`, such as `start`, `stop`,
      `stride`, `detectors` (by name, only these), `mapper`, `rule`, `resume`.

    Errors as of `afkb_mapping.run.make_map`; then nothing has been written.
    """
    return _made(source, Path(out), add, extensions, options, progress, settings)


def update_map(
    folder: str | Path,
    source: str | Path,
    *,
    add: Sequence[object] = (),
    extensions: Sequence[str | Path] = (),
    options: Mapping[str, str] | None = None,
    progress: Callable[[Progress], None] = lambda _: None,
    **settings: Any,
) -> OpenMap:
    """Add a later visit to a map, and open it; `hours_later` where stamps don't tell.

    Arguments and errors as of `map_recording`; `MapError` where the visit can't be placed.
    """
    later = {**settings, "update": True}
    return _made(source, Path(folder), add, extensions, options, progress, later)


def _made(
    source: str | Path,
    out: Path,
    add: Sequence[object],
    extensions: Sequence[str | Path],
    options: Mapping[str, str] | None,
    progress: Callable[[Progress], None],
    settings: Mapping[str, Any],
) -> OpenMap:
    from afkb_mapping.run import make_map

    host = PluginHost(extensions=[Path(file) for file in extensions])
    bring(host, add)
    asked = Settings(uri=str(source), out=out, options=dict(options or {}), **settings)
    if make_map(host, asked, progress).interrupted is not None:
        raise KeyboardInterrupt(f"{out} holds what was seen until then")
    return open_map(asked.out)


def route(folder: str | Path, start: str, goal: str, robot_radius_m: float = 0.2) -> Route:
    """The shortest way between two places: `x,y` (m), a node's id, or a room by id or kind.

    `RouteError` where there is no such place or no way. To look for a thing: `search`.
    """
    from afkb_mapping.routes.planner import Planner

    known, (first, last), _ = _ends(folder, start, goal)
    return Planner.of(known, robot_radius_m).route_round(first, last)


def search(folder: str | Path, start: str, thing: str, robot_radius_m: float = 0.2) -> Search:
    """The order of places in which to look for a thing, that of the least expected way.

    `RouteError` where there is no such place, or no kind of thing of that name.
    """
    from afkb.errors import RouteError
    from afkb_mapping.routes.ends import Kind
    from afkb_mapping.routes.planner import Planner
    from afkb_mapping.routes.search import search as searched

    known, (first, last), kb = _ends(folder, start, thing)
    if not isinstance(last, Kind):
        raise RouteError(f"{thing} is a place, not a kind of thing; `route` leads there")
    return searched(Planner.of(known, robot_radius_m), kb, first, last)


def _ends(folder: str | Path, *names: str) -> tuple[RouteMap, list[End], AfNet]:
    from afkb_mapping.routes.ends import end_of
    from afkb_mapping.routes.route_map import RouteMap

    known, kb = RouteMap.read(Path(folder).expanduser()), open_map(folder).knowledge_base
    return known, [end_of(name, known, kb) for name in names], kb


def changes(earlier: str | Path, later: str | Path) -> Difference:
    """What moved, vanished and appeared between two maps of one place, or two visits."""
    from afkb_mapping.visits.diff import diff

    return diff(Path(earlier).expanduser(), Path(later).expanduser())
