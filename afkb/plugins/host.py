"""Finds plugins, loads them, and asks them; built-in ones have no privilege here."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from importlib.metadata import EntryPoint, entry_points
from pathlib import Path
from typing import TYPE_CHECKING, Protocol, TypeVar
from urllib.parse import urlsplit
from urllib.request import url2pathname

import pluggy

from afkb.errors import PluginError, SourceError
from afkb.knowledge import AfNet
from afkb.plugins import PROJECT, hookspecs
from afkb.plugins.protocols import (
    Detector,
    Exporter,
    MapperFactory,
    Predictor,
    RoomClassifier,
    Source,
    Viewer,
)

if TYPE_CHECKING:  # Every command loads this; few of them need arrays.
    from afkb.flow import Truth


class _Named(Protocol):
    @property
    def name(self) -> str: ...


T = TypeVar("T", bound=_Named)


@dataclass(frozen=True, slots=True)
class PluginInfo:
    """One registered plugin: its entry point name, distribution and version, and its hooks."""

    name: str
    module: str
    distribution: str
    version: str
    hooks: tuple[str, ...]


def _manager() -> pluggy.PluginManager:
    manager = pluggy.PluginManager(PROJECT)
    manager.add_hookspecs(hookspecs)
    return manager


def _load(manager: pluggy.PluginManager, found: EntryPoint) -> None:
    origin = found.dist.name if found.dist else "an unknown distribution"
    try:
        manager.register(found.load(), name=found.name)
        manager.check_pending()
    except (pluggy.PluginValidationError, ImportError, AttributeError, ValueError) as error:
        reason = " ".join(str(error).split())
        raise PluginError(
            f"plugin {found.name!r} of {origin} ({found.value}) does not load: {reason}; "
            f"mend it, or remove it with: pip uninstall {origin}"
        ) from error


class PluginHost:
    """The registered plugins and the knowledge base that every hook is handed.

    `ontology` replaces the bundled ontology; `extensions` are files added to it, besides
    those that plugins bring through `afkb_ontologies`.
    """

    def __init__(self, ontology: Path | None = None, extensions: Sequence[Path] = ()) -> None:
        self.manager = _manager()
        self._ontology = ontology
        self._extensions = tuple(extensions)
        found = sorted(entry_points(group=PROJECT), key=lambda e: e.name)
        self._entry_points = {e.name: e for e in found}
        for entry_point in self._entry_points.values():
            _load(self.manager, entry_point)

    def register(self, plugin: object, name: str | None = None) -> None:
        """Add a plugin object directly, as tests and scripts do."""
        self.manager.register(plugin, name=name)

    @cached_property
    def knowledge_base(self) -> AfNet:
        """The ontology with every extension, read when it is first used."""
        base = AfNet(self._ontology, self._extensions)
        brought = self.manager.hook.afkb_ontologies(knowledge_base=base)
        paths = [Path(p) for group in brought for p in group]
        return base.extended(paths) if paths else base

    def plugins(self) -> list[PluginInfo]:
        """Every registered plugin with its origin, by name."""
        return [self._info(name, plugin) for name, plugin in self.manager.list_name_plugin()]

    def _info(self, name: str, plugin: object) -> PluginInfo:
        entry = self._entry_points.get(name)
        dist = entry.dist if entry else None
        callers = self.manager.get_hookcallers(plugin) or []
        return PluginInfo(
            name=name,
            module=entry.value if entry else type(plugin).__name__,
            distribution=dist.name if dist else "(registered by hand)",
            version=dist.version if dist else "",
            hooks=tuple(sorted(c.name for c in callers)),
        )

    def open_source(self, uri: str, options: Mapping[str, str] | None = None) -> Source:
        """The recording at `uri`, opened by whichever plugin knows it; `SourceError` if none.

        `file://` URIs and `~` stand for paths.
        """
        uri = _as_path(uri)
        source = self.manager.hook.afkb_open_source(
            uri=uri, options=dict(options or {}), knowledge_base=self.knowledge_base
        )
        if source is None:
            if "://" not in uri and not Path(uri).exists():
                raise SourceError(f"{uri}: no such file or folder")
            raise SourceError(
                f"{uri}: no source plugin recognises it; "
                "see `afkb plugins --hook afkb_open_source` and docs/your-own-data.md"
            )
        return source  # type: ignore[no-any-return]

    def truth(self, uri: str) -> Truth | None:
        """What is so where the recording at `uri` was made; None where no plugin knows it.

        Maps are judged by it. Nothing that makes them asks for it.
        """
        found: Truth | None = self.manager.hook.afkb_truth(
            uri=_as_path(uri), knowledge_base=self.knowledge_base
        )
        return found

    def detectors(self, names: Sequence[str] = ()) -> list[Detector]:
        """The named detectors, or all that run by default, in order of stage."""
        detectors: list[Detector] = self._collect(self.manager.hook.afkb_detectors)
        return sorted(_chosen("detector", detectors, names), key=lambda d: d.stage)

    def predictors(self, names: Sequence[str] = ()) -> list[Predictor]:
        """The named predictors, or all, in order of filtration."""
        predictors: list[Predictor] = self._collect(self.manager.hook.afkb_predictors)
        return sorted(_chosen("predictor", predictors, names), key=lambda p: p.order)

    def mapper_factory(self, name: str) -> MapperFactory:
        """The factory of the named mapper."""
        factories: list[MapperFactory] = self._collect(self.manager.hook.afkb_mappers)
        return _chosen("mapper", factories, [name])[0]

    def room_classifiers(self, names: Sequence[str] = ()) -> list[RoomClassifier]:
        """The named classifiers of rooms, or all."""
        classifiers: list[RoomClassifier] = self._collect(self.manager.hook.afkb_room_classifiers)
        return _chosen("room classifier", classifiers, names)

    def exporters(self, names: Sequence[str] = ()) -> list[Exporter]:
        """The named exporters, or all."""
        exporters: list[Exporter] = self._collect(self.manager.hook.afkb_exporters)
        return _chosen("exporter", exporters, names)

    def viewers(self, names: Sequence[str]) -> list[Viewer]:
        """The named viewers; none where none is named."""
        if not names:
            return []
        viewers: list[Viewer] = self._collect(self.manager.hook.afkb_viewers)
        return _chosen("viewer", viewers, names)

    def _collect(self, hook: pluggy.HookCaller) -> list[T]:
        groups: Iterable[Iterable[T]] = hook(knowledge_base=self.knowledge_base)
        return sorted((item for group in groups for item in group), key=lambda item: item.name)


def _as_path(uri: str) -> str:
    """A `file://` URI or a path from the home folder as a plain path; other URIs as they are."""
    if uri.startswith("file://"):
        return url2pathname(urlsplit(uri).path)
    return str(Path(uri).expanduser()) if uri.startswith("~") else uri


def _chosen(what: str, items: list[T], names: Sequence[str]) -> list[T]:
    """The items of those names; if there are none, all but those with `by_default` False.

    Raises `PluginError` for a name nobody has.
    """
    by_name: dict[str, T] = {}
    for item in items:
        if item.name in by_name:
            raise PluginError(f"two {what}s are named {item.name!r}; rename or remove one")
        by_name[item.name] = item
    unknown = [n for n in names if n not in by_name]
    if unknown:
        known = ", ".join(sorted(by_name)) or "none"
        raise PluginError(f"no {what} named {unknown[0]!r}; registered: {known}")
    if not names:
        return [item for item in items if getattr(item, "by_default", True)]
    return [by_name[n] for n in dict.fromkeys(names)]
