"""The paper's three scenarios: what it tells of each, and what is mapped in its place."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from afkb.errors import SourceError
from afkb.plugins.host import PluginHost
from afkb_paper.truth_file import FILE


@dataclass(frozen=True, slots=True)
class Figures:
    """What the paper tells of a scenario (§II.F, §III); None where it tells nothing.

    `rooms`, `baseline`: rooms told rightly by affordances, and by doors and walls [11].
    """

    places: int
    rooms: int
    baseline: int
    loop_m: str
    transient: str | None = None
    hidden: str | None = None
    dynamic: str | None = None


@dataclass(frozen=True, slots=True)
class Scenario:
    """One of the three: its number, the paper's figure, and the world that comes with afkb."""

    number: int
    title: str
    world: str
    paper: Figures
    recorded: bool = True
    """Whether a recorded home may take the world's place."""


SCENARIOS = (
    Scenario(
        1,
        "simulated home (Fig. 2)",
        "world:paper_home",
        Figures(
            places=6,
            rooms=4,
            baseline=2,
            loop_m="~ 0",
            transient="~ 3",
            hidden="identified before it is seen",
            dynamic="not used for matching",
        ),
        recorded=False,
    ),
    Scenario(2, "domestic (Fig. 3)", "world:family_flat", Figures(8, 4, 2, "< 0.25")),
    Scenario(3, "domestic (Fig. 4)", "world:small_flat", Figures(4, 2, 2, "< 0.25")),
)


def sources(homes: Path | None, host: PluginHost) -> dict[Scenario, str]:
    """What to map for each scenario: a home of the folder, else the world.

    The home is the one with most nearly as many rooms as the paper's; none is taken twice, and of
    those that have as many the first by name is.

    Raises `SourceError` where a home's truth can't be read.
    """
    free = _homes(homes, host) if homes is not None else {}
    found = {}
    for scenario in SCENARIOS:
        found[scenario] = scenario.world
        if scenario.recorded and free:
            nearest = min(free, key=lambda uri: abs(free[uri] - scenario.paper.rooms))
            found[scenario] = nearest
            free.pop(nearest)
    return found


def _homes(folder: Path, host: PluginHost) -> dict[str, int]:
    """Recordings of homes with their truth: URI to in how many rooms the robot was."""
    if not folder.is_dir():
        raise SourceError(f"{folder}: no such folder; name one with --data, or leave it out")
    found = {}
    for home in sorted(folder.iterdir()):
        recording = home / "bag" if (home / "bag").exists() else home
        if (home / FILE).is_file() and (truth := host.truth(str(recording))) is not None:
            found[str(recording)] = len({v.room for v in truth.views if v.room})
    return found
