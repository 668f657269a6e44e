"""A bag as a lazy, re-readable recording: moments are indexed, images and scans are streamed."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from rosbags.highlevel import AnyReader
from rosbags.interfaces import Connection

from afkb.errors import BadFrame, SourceError
from afkb.flow import LaserScan, SkippedFrame, View
from afkb.plugins.options import read_options
from afkb_mapping.recordings.pose_track import NS
from afkb_rosbag.depth_message import depth_of
from afkb_rosbag.frames import Frames, choose_frames
from afkb_rosbag.index import Index, build_index
from afkb_rosbag.options import BagOptions
from afkb_rosbag.recording import decoded, header_of, messages, opened
from afkb_rosbag.topics import Topics, choose_topics

_NOWHERE = np.iinfo(np.int64).min


@dataclass(frozen=True, slots=True)
class Pairing:
    """Which messages make a frame, as arrays a row a frame, ns.

    `stamps`: of the sensor that leads, depth if there is any. `scan_stamps`: of the scan beside
    it, or `_NOWHERE`. `received`: (N, 2), earliest and latest time of recording of its messages.
    """

    stamps: NDArray[np.int64]
    scan_stamps: NDArray[np.int64]
    received: NDArray[np.int64]


@dataclass(eq=False)
class BagSource:
    """Depth images and scans of a bag, paired by stamp and placed by tf.

    A robot's odometry has z up (REP-105), so it is `gravity_aligned`; a hand-held camera's world
    need not be.
    """

    uri: str
    gravity_aligned: bool
    path: Path
    topics: Topics
    index: Index
    frames: Frames
    pairing: Pairing

    def __len__(self) -> int:
        return len(self.pairing.stamps)

    def views(
        self, start: int = 0, stop: int | None = None, stride: int = 1
    ) -> Iterator[View | SkippedFrame]:
        """Frames of the slice in one pass over that part of the bag; no other image is decoded."""
        wanted = range(len(self))[start:stop:stride]
        if not wanted:
            return
        with opened(self.path) as reader:
            for index, found in self._found(reader, wanted):
                try:
                    yield self._view(reader, index, found)
                except BadFrame as error:
                    yield SkippedFrame(index, self._where(index), str(error))

    def _where(self, index: int) -> str:
        lead = self.topics.depth or self.topics.scan
        return f"{self.uri} {lead} at {self.pairing.stamps[index] / NS:.3f} s"

    def _needs(self, index: int) -> list[tuple[str, int]]:
        """Topic and stamp (ns) of each message that the frame is made of."""
        needs: list[tuple[str, int]] = []
        if self.topics.depth is not None:
            needs.append((self.topics.depth, int(self.pairing.stamps[index])))
        scan_stamp = int(self.pairing.scan_stamps[index])
        if self.topics.scan is not None and scan_stamp != _NOWHERE:
            needs.append((self.topics.scan, scan_stamp))
        return needs

    def _found(
        self, reader: AnyReader, wanted: range
    ) -> Iterator[tuple[int, dict[str, tuple[Connection, bytes]]]]:
        """Raw messages of each wanted frame; only those recorded ahead of their turn are held."""
        last_use = {need: index for index in wanted for need in self._needs(index)}
        received = self.pairing.received[wanted.start : wanted[-1] + 1 : wanted.step]
        used = [c for c in reader.connections if c.topic in (self.topics.depth, self.topics.scan)]
        begin, end = int(received[:, 0].min()), int(received[:, 1].max()) + 1
        stream = messages(reader, self.path, used, begin, end)
        held: dict[tuple[str, int], tuple[Connection, bytes]] = {}
        for index in wanted:
            needs = self._needs(index)
            while any(need not in held for need in needs):
                item = next(stream, None)
                if item is None:
                    raise SourceError(f"{self.uri}: it changed since it was opened; open it again")
                connection, at, raw = item
                key = (connection.topic, header_of(raw, at, reader.is2).stamp)
                if last_use.get(key, -1) >= index:
                    held.setdefault(key, (connection, raw))
            yield index, {topic: held[topic, stamp] for topic, stamp in needs}
            held = {need: m for need, m in held.items() if last_use[need] > index}

    def _view(
        self, reader: AnyReader, index: int, found: Mapping[str, tuple[Connection, bytes]]
    ) -> View:
        stamp, scan_stamp = (int(s[index]) for s in (self.pairing.stamps, self.pairing.scan_stamps))
        depth = found.get(self.topics.depth or "")
        scan = found.get(self.topics.scan or "")
        frames = self.frames
        return View(
            index=index,
            stamp=stamp / NS,
            T_odom_base=frames.T_odom_base(stamp),
            depth_m=None if depth is None else depth_of(decoded(reader, *depth)),
            camera=None if depth is None else self.index.camera_at(stamp),
            T_base_camera=None if depth is None else frames.T_base_camera(stamp),
            scan=None if scan is None else scan_of(decoded(reader, *scan)),
            T_base_laser=None if scan is None else frames.T_base_laser(stamp, scan_stamp),
            has_base=frames.base is not None,
        )


def scan_of(message: Any) -> LaserScan:
    """A `sensor_msgs/LaserScan`; a range_max that is unset sets no limit."""
    return LaserScan(
        ranges_m=np.asarray(message.ranges, dtype=np.float32),
        angle_min=float(message.angle_min),
        angle_increment=float(message.angle_increment),
        range_min_m=float(message.range_min),
        range_max_m=float(message.range_max) if message.range_max > 0 else float("inf"),
    )


def open_bag(uri: str, options: Mapping[str, str]) -> BagSource:
    """Index the bag; `SourceError` where it cannot give a single view."""
    chosen = read_options(BagOptions, uri, options)
    path = Path(uri)
    with opened(path) as reader:
        topics = choose_topics(reader, path, chosen)
        try:
            index = build_index(reader, path, topics, chosen)
        except BadFrame as error:
            raise SourceError(f"{path}: {error}") from error
    frames = choose_frames(index, chosen, path)
    pairing = pair(index, chosen.max_dt)
    return BagSource(uri, frames.base is not None, path, topics, index, frames, pairing)


def pair(index: Index, max_dt: float) -> Pairing:
    """Frames led by depth, each with the scan nearest in time within `max_dt` s; else by scans."""
    scans, scans_received = index.scan.in_order()
    if not len(index.depth):
        return Pairing(scans, scans, np.column_stack([scans_received, scans_received]))
    stamps, received = index.depth.in_order()
    spans = np.column_stack([received, received])
    nearest = _nearest(scans, stamps)
    if nearest is None:
        return Pairing(stamps, np.full_like(stamps, _NOWHERE), spans)
    near = np.abs(scans[nearest] - stamps) <= max_dt * NS
    spans[near, 0] = np.minimum(spans[near, 0], scans_received[nearest[near]])
    spans[near, 1] = np.maximum(spans[near, 1], scans_received[nearest[near]])
    return Pairing(stamps, np.where(near, scans[nearest], _NOWHERE), spans)


def _nearest(sorted_stamps: NDArray[np.int64], stamps: NDArray[np.int64]) -> Any:
    """Index of the nearest of `sorted_stamps` to each stamp, or None if there are none."""
    if not len(sorted_stamps):
        return None
    after = np.clip(np.searchsorted(sorted_stamps, stamps), 1, max(len(sorted_stamps) - 1, 1))
    after = np.minimum(after, len(sorted_stamps) - 1)
    before = np.maximum(after - 1, 0)
    closer = stamps - sorted_stamps[before] <= sorted_stamps[after] - stamps
    return np.where(closer, before, after)
