"""A tree of frames over time: links recorded one by one, looked up as a chain at one moment."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from afkb.errors import BadFrame
from afkb_mapping.recordings.pose_track import Track


def inverse(T: NDArray[np.float64]) -> NDArray[np.float64]:
    """Inverse of a rigid transform (4, 4)."""
    R = T[:3, :3].T
    inverted = np.eye(4)
    inverted[:3, :3] = R
    inverted[:3, 3] = -R @ T[:3, 3]
    return inverted


@dataclass
class FrameTree:
    """Links between frames, keyed (parent, child); `max_dt` and `max_gap` as in `Track.at`."""

    max_dt: float
    max_gap: float
    links: dict[tuple[str, str], Track] = field(default_factory=dict)
    _chains: dict[tuple[str, str], list[tuple[str, str]] | None] = field(default_factory=dict)

    def track(self, parent: str, child: str, static: bool = False) -> Track:
        """The link's track, made on first use; a static link that also moves is a moving one."""
        key = (parent, child)
        found = self.links.get(key)
        if found is None or (found.static and not static):
            found = self.links[key] = Track(static)
            self._chains.clear()
        return found

    def replace_parent(self, parent: str, child: str, track: Track) -> None:
        """Hang `child` under `parent` by that track and no other."""
        self.links = {k: t for k, t in self.links.items() if k[1] != child}
        self.links[(parent, child)] = track
        self._chains.clear()

    def keep_only(self, ends: Sequence[tuple[str, str]]) -> None:
        """Forget every link that lies on no chain between these pairs of frames."""
        steps = {step for a, b in ends for step in self._chain(a, b) or ()}
        used = steps | {(child, parent) for parent, child in steps}
        self.links = {key: track for key, track in self.links.items() if key in used}

    @property
    def frames(self) -> set[str]:
        """Names of all frames that a usable link touches."""
        return {name for link, track in self.links.items() if len(track) for name in link}

    def root_of(self, frame: str) -> str:
        """The topmost ancestor of a frame."""
        parents = {child: parent for (parent, child), track in self.links.items() if len(track)}
        seen = {frame}
        while frame in parents and parents[frame] not in seen:
            frame = parents[frame]
            seen.add(frame)
        return frame

    def connected(self, a: str, b: str) -> bool:
        """Whether any chain of links leads from one frame to the other."""
        return self._chain(a, b) is not None

    def moves(self, a: str, b: str) -> bool:
        """Whether a link that changes over time lies between two frames."""
        return any(not self._link(*step)[0].static for step in self._chain(a, b) or ())

    def lookup(self, a: str, b: str, stamp: int) -> NDArray[np.float64]:
        """T_a_b (4, 4) at a stamp (ns); `BadFrame` names the link that has a gap there."""
        chain = self._chain(a, b)
        if chain is None:
            raise BadFrame(f"no tf between {a!r} and {b!r}")
        T = np.eye(4)
        for step in chain:
            track, forward = self._link(*step)
            try:
                T_step = track.at(stamp, self.max_dt, self.max_gap)
            except BadFrame as error:
                raise BadFrame(f"tf {step[0]} → {step[1]}: {error}") from error
            T = T @ (T_step if forward else inverse(T_step))
        return T

    def _link(self, a: str, b: str) -> tuple[Track, bool]:
        track = self.links.get((a, b))
        return (track, True) if track is not None else (self.links[(b, a)], False)

    def _chain(self, a: str, b: str) -> list[tuple[str, str]] | None:
        if (a, b) not in self._chains:
            self._chains[(a, b)] = self._search(a, b)
        return self._chains[(a, b)]

    def _search(self, a: str, b: str) -> list[tuple[str, str]] | None:
        """Shortest chain of steps by breadth, neighbours by name, so that it is always the same."""
        neighbours: dict[str, set[str]] = {}
        for (parent, child), track in self.links.items():
            if len(track):
                neighbours.setdefault(parent, set()).add(child)
                neighbours.setdefault(child, set()).add(parent)
        came_from: dict[str, str] = {a: a}
        queue = deque([a])
        while queue and b not in came_from:
            here = queue.popleft()
            for there in sorted(neighbours.get(here, ())):
                if there not in came_from:
                    came_from[there] = here
                    queue.append(there)
        if b not in came_from:
            return None
        steps: list[tuple[str, str]] = []
        while b != a:
            steps.append((came_from[b], b))
            b = came_from[b]
        return steps[::-1]
