"""Who looks on while a map is made: viewers, which change nothing in it."""

from __future__ import annotations

import logging
from collections.abc import Callable, Sequence

from afkb.errors import PluginError
from afkb.flow import Detection, TopologicalMap, View
from afkb.plugins.host import PluginHost
from afkb.plugins.protocols import Viewer

LOG = logging.getLogger("afkb_mapping")


class Audience:
    """The viewers of a run. One that fails is named in the log and gets no more; the run goes on.

    A map took long to make, and whoever only looks on must not cost it.
    """

    def __init__(self, viewers: Sequence[Viewer] = ()) -> None:
        self._viewers = list(viewers)

    @classmethod
    def of(cls, host: PluginHost, asked: Sequence[str], uri: str) -> Audience:
        """The viewers asked for as `NAME` or `NAME=TARGET`, begun with the recording's URI.

        Raises `PluginError` for unknown ones and for those that can't show anything.
        """
        targets = {name: target or None for name, _, target in (a.partition("=") for a in asked)}
        viewers = host.viewers(list(targets))
        for viewer in viewers:
            _begun(viewer, uri, targets[viewer.name])
        return cls(viewers)

    def show(self, view: View, detections: Sequence[Detection]) -> None:
        """A placed view and what was detected in it."""
        self._each(lambda viewer: viewer.show(view, detections))

    def end(self, topological_map: TopologicalMap) -> None:
        """The finished map."""
        self._each(lambda viewer: viewer.end(topological_map))

    def _each(self, act: Callable[[Viewer], None]) -> None:
        for viewer in list(self._viewers):
            try:
                act(viewer)
            except Exception as error:
                self._viewers.remove(viewer)
                why = f"{type(error).__name__}: {error}"
                LOG.warning("viewer %r failed with %s; it is shown no more", viewer.name, why)


def _begun(viewer: Viewer, uri: str, target: str | None) -> None:
    try:
        viewer.begin(uri, target)
    except PluginError:
        raise
    except Exception as error:
        raise PluginError(
            f"viewer {viewer.name!r} failed with {type(error).__name__}: {error}; "
            "mend it, or leave --view out"
        ) from error
