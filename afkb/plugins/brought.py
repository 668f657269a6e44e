"""A plugin made of parts at hand, for scripts and notebooks."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from afkb.errors import PluginError
from afkb.plugins import hookimpl
from afkb.plugins.protocols import Detector, Exporter, Predictor, RoomClassifier

if TYPE_CHECKING:
    from afkb.knowledge import AfNet
    from afkb.plugins.host import PluginHost


class Brought:
    """Brings detectors, predictors, room classifiers and exporters through their hooks."""

    def __init__(self, parts: Sequence[object]) -> None:
        self._parts = tuple(parts)

    @hookimpl
    def afkb_detectors(self, knowledge_base: AfNet) -> Iterable[Detector]:
        """Return the detectors among them."""
        return [part for part in self._parts if isinstance(part, Detector)]

    @hookimpl
    def afkb_predictors(self, knowledge_base: AfNet) -> Iterable[Predictor]:
        """Return the predictors among them."""
        return [part for part in self._parts if isinstance(part, Predictor)]

    @hookimpl
    def afkb_room_classifiers(self, knowledge_base: AfNet) -> Iterable[RoomClassifier]:
        """Return the room classifiers among them."""
        return [part for part in self._parts if isinstance(part, RoomClassifier)]

    @hookimpl
    def afkb_exporters(self, knowledge_base: AfNet) -> Iterable[Exporter]:
        """Return the exporters among them."""
        return [part for part in self._parts if isinstance(part, Exporter)]


_KINDS = (Detector, Predictor, RoomClassifier, Exporter)


def bring(host: PluginHost, parts: Sequence[object]) -> None:
    """Register parts by what they are; an object with hooks of its own is a plugin as it stands.

    `PluginError` for an object that is neither.
    """
    single = [part for part in parts if isinstance(part, _KINDS)]
    for part in parts:
        if isinstance(part, _KINDS):
            continue
        if not _has_hooks(host, part):
            raise PluginError(
                f"{part!r} is no detector, predictor, room classifier, exporter or plugin; "
                "docs/writing-a-plugin.md says what these must have"
            )
        host.register(part)
    if single:
        host.register(Brought(single))


def _has_hooks(host: PluginHost, part: object) -> bool:
    return any(host.manager.parse_hookimpl_opts(part, name) for name in dir(part))
