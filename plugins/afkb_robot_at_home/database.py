"""What is asked of `rh.db`, as plain rows; its tables as the authors' toolbox reads them."""

from __future__ import annotations

import sqlite3
from collections.abc import Iterator, Sequence
from contextlib import closing, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from afkb.errors import SourceError
from afkb.flow import LaserScan
from afkb_mapping.recordings.pose_track import NS

_TICKS_FROM_1601_TO_1970 = 116_444_736_000_000_000
_NS_A_TICK = 100
_POSE = ", ".join(f"o.sensor_pose_{axis}" for axis in ("x", "y", "z", "yaw", "pitch", "roll"))
_OF_A_VISIT = (
    "JOIN rh_homes h ON h.id = o.home_id JOIN rh_sensors s ON s.id = o.sensor_id "
    "JOIN rh_rooms r ON r.id = o.room_id "
    "WHERE h.name = ? AND o.home_session_id = ? AND s.name = ? "
    "AND (? IS NULL OR r.name = ? OR r.name = h.name || '_' || ?) ORDER BY o.time_stamp, o.id"
)
_IMAGES = (
    f"SELECT o.id, o.time_stamp, {_POSE}, f.new_path, f.new_file_1 FROM rh_lblrgbd o "
    f"JOIN rh2_old2new_rgbd_files f ON f.id = o.id {_OF_A_VISIT}"
)
_SCANS = (
    f"SELECT o.id, o.time_stamp, {_POSE}, o.laser_aperture, o.laser_max_range FROM rh_lsrscan o "
    f"{_OF_A_VISIT}"
)
_BEAMS = (
    "SELECT scan, valid_scan FROM rh_lsrscan_scans WHERE sensor_observation_id = ? ORDER BY shot_id"
)
_VISITS = (
    "SELECT DISTINCT h.name, o.home_session_id FROM rh_lblrgbd o "
    "JOIN rh_homes h ON h.id = o.home_id ORDER BY 1, 2"
)


@dataclass(frozen=True, slots=True)
class Observation:
    """One image or scan: when (ns since 1970), the sensor's pose as stated, and what it holds.

    `pose`: x, y, z (m), yaw, pitch, roll (rad). `about`: an image's folder and depth file, or a
    scan's aperture (rad) and farthest range (m).
    """

    id: int
    stamp: int
    pose: tuple[float, ...]
    about: tuple[Any, ...]


@dataclass(frozen=True, slots=True)
class Database:
    """The file, opened for reading alone whenever something is asked."""

    path: Path

    def visits(self) -> list[tuple[str, int]]:
        """Homes with labelled images, and their sessions, counted from 0."""
        with self.asked() as ask:
            return [(str(home), int(session)) for home, session in ask(_VISITS, ())]

    def images(self, home: str, session: int, sensor: str, room: str | None) -> list[Observation]:
        """A camera's labelled images of one visit, in order of time."""
        return self._observations(_IMAGES, home, session, sensor, room)

    def scans(self, home: str, session: int, sensor: str, room: str | None) -> list[Observation]:
        """A laser's scans of one visit, in order of time."""
        return self._observations(_SCANS, home, session, sensor, room)

    def _observations(self, sql: str, *visit: Any) -> list[Observation]:
        home, session, sensor, room = visit
        with self.asked() as ask:
            rows = ask(sql, (home, session, sensor, room, room, room))
        return [Observation(row[0], _unix(row[1]), tuple(row[2:8]), tuple(row[8:])) for row in rows]

    def scan(self, observation: Observation) -> LaserScan:
        """The scan of an observation; beams that the dataset calls invalid are no return."""
        with self.asked() as ask:
            rows = ask(_BEAMS, (observation.id,))
        aperture, farthest = map(float, observation.about)
        beams = np.array(rows, dtype=np.float32).reshape(-1, 2)
        ranges: NDArray[np.float32] = np.where(beams[:, 1] > 0, beams[:, 0], np.inf)
        step = aperture / max(len(ranges) - 1, 1)
        return LaserScan(ranges.astype(np.float32), -aperture / 2, step, 0.02, farthest)

    @contextmanager
    def asked(self) -> Iterator[Any]:
        """A function from SQL and values to rows; `SourceError` where it is no such database."""

        def ask(sql: str, values: Sequence[Any]) -> list[Any]:
            return connection.execute(sql, tuple(values)).fetchall()

        try:
            uri = f"{self.path.resolve().as_uri()}?mode=ro"
            with closing(sqlite3.connect(uri, uri=True)) as connection:
                yield ask
        except sqlite3.Error as error:
            raise SourceError(
                f"{self.path}: is no Robot@Home2 database: {error}; expected rh.db of version 2"
            ) from error


def _unix(ticks: int) -> int:
    """Nanoseconds since 1970 of 100 ns since 1601, Windows' count, which the dataset keeps."""
    return (int(ticks) - _TICKS_FROM_1601_TO_1970) * _NS_A_TICK


def seconds(stamp: int) -> float:
    """A stamp in seconds."""
    return stamp / NS
