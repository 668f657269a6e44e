"""One recording of a batch: what is to be done, and what became of it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import StrEnum
from pathlib import Path
from typing import Any

from afkb_mapping.run_record import Settings


class JobState(StrEnum):
    """What became of a recording."""

    MAPPED = "mapped"
    RESUMED = "resumed"
    SKIPPED = "skipped"
    FAILED = "failed"


@dataclass(frozen=True, slots=True)
class Job:
    """A recording to map: what its map is called, how it is made, and within which limits.

    `threads`: of the libraries that compute in several. `seconds`: after which it is given up.
    """

    name: str
    settings: Settings
    ontology: tuple[Path, ...] = ()
    threads: int = 1
    seconds: float | None = None

    def as_json(self) -> dict[str, Any]:
        """What another process makes the same job of."""
        asked = {name: getattr(self.settings, name) for name in Settings.__dataclass_fields__}
        return {
            "name": self.name,
            "settings": asked | {"out": str(self.settings.out)},
            "ontology": [str(file) for file in self.ontology],
        }

    @classmethod
    def from_json(cls, told: dict[str, Any]) -> Job:
        """The job that another process told of."""
        asked: dict[str, Any] = {
            name: tuple(value) if isinstance(value, list) else value
            for name, value in told["settings"].items()
        }
        asked["out"] = Path(asked["out"])
        settings = Settings(**asked)
        return cls(told["name"], settings, tuple(Path(file) for file in told["ontology"]))


@dataclass(frozen=True, slots=True)
class Outcome:
    """What became of a job: the map's figures, or in one line why there is none.

    `seconds`: from start to end. `stored`: the graph of the server that keeps it, if one was named.
    `error` of a map that stands: why the server does not keep it.
    """

    name: str
    source: str
    out: Path
    state: JobState
    error: str | None = None
    seconds: float = 0.0
    frames: int = 0
    skipped_frames: int = 0
    things: int = 0
    rooms: int = 0
    peak_memory_mb: float = 0.0
    stored: str | None = None

    @classmethod
    def of(cls, job: Job, state: JobState, **facts: Any) -> Outcome:
        """What became of this job."""
        return cls(job.name, job.settings.uri, job.settings.out, state, **facts)

    def and_(self, **facts: Any) -> Outcome:
        """The same, with more known."""
        return replace(self, **facts)

    def as_json(self) -> dict[str, Any]:
        """The shape that docs/reference.md states."""
        told = {name: getattr(self, name) for name in self.__dataclass_fields__ if name != "out"}
        return {**told, "map": str(self.out), "state": self.state.value}
