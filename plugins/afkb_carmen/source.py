"""A CARMEN log as a lazy, re-readable recording of laser scans."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, ConfigDict, Field, PositiveFloat

from afkb.errors import BadFrame, SourceError
from afkb.flow import SkippedFrame, View
from afkb.plugins.options import read_options
from afkb_carmen.index import LogIndex, build_index, scan_tag
from afkb_carmen.lines import ScanLine, parse_scan
from afkb_mapping.geometry import T_from_xy_yaw


class CarmenOptions(BaseModel):
    """What a user may say about a log.

    - `poses`: `robot` takes the robot's pose of each scan line; `odom` adds up the steps of the
      ODOM lines, raw odometry also where a mapper wrote its estimates into the scan lines.
    - `fov`: degrees that a FLASER spans, for the line does not say.
    - `max_range`: m, from where on a FLASER reading means that nothing came back.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)
    poses: Literal["robot", "odom"] = "robot"
    fov: float = Field(180.0, gt=0, le=360)
    max_range: PositiveFloat = 80.0


@dataclass(eq=False)
class CarmenSource:
    """Scans of a log with the odometry at each; the robot drives on a floor, so z is up."""

    uri: str
    path: Path
    index: LogIndex
    options: CarmenOptions
    gravity_aligned: bool = field(default=True, init=False)

    def __len__(self) -> int:
        return len(self.index.offsets)

    def views(
        self, start: int = 0, stop: int | None = None, stride: int = 1
    ) -> Iterator[View | SkippedFrame]:
        """Frames of the slice; each scan line is sought and parsed when its turn comes."""
        with self.path.open("rb") as file:
            for index in range(len(self))[start:stop:stride]:
                file.seek(int(self.index.offsets[index]))
                try:
                    yield self._view(index, self._parse(file.readline()))
                except BadFrame as error:
                    where = f"{self.uri} line {self.index.numbers[index]}"
                    yield SkippedFrame(index, where, str(error))

    def _parse(self, line: bytes) -> ScanLine:
        return parse_scan(line, math.radians(self.options.fov), self.options.max_range)

    def _view(self, index: int, line: ScanLine) -> View:
        return View(
            index=index,
            stamp=line.stamp,
            T_odom_base=self._T_odom_base(index, line),
            scan=line.scan,
            T_base_laser=self.index.T_base_laser,
        )

    def _T_odom_base(self, index: int, line: ScanLine) -> NDArray[np.float64]:
        if self.options.poses == "odom":
            return self.index.T_chained(index)
        return T_from_xy_yaw(*line.robot)


def open_log(uri: str, options: Mapping[str, str]) -> CarmenSource:
    """Index the log; `SourceError` where it has no scan."""
    chosen = read_options(CarmenOptions, uri, options)
    path = Path(uri)
    tag = scan_tag(path)
    if tag is None:
        raise SourceError(
            f"{path}: a CARMEN log without laser scans; expected lines FLASER or ROBOTLASER1"
        )
    return CarmenSource(uri, path, build_index(path, tag), chosen)
