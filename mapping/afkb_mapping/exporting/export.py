"""A stored map written in another format, by whichever exporter has it."""

from __future__ import annotations

import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from afkb.errors import AfkbError, MapError, PluginError
from afkb.plugins.host import PluginHost
from afkb.plugins.protocols import AdjustableExporter, Exporter, SceneExporter
from afkb.store import StoredMap, load
from afkb.store.stored import SCENE_FILE
from afkb.store.stored_map import read_map, run_of
from afkb_mapping.exporting.delivery import deliver


@dataclass(frozen=True, slots=True)
class Format:
    """A format that a map can be written in: its name, what it is, and the options it takes."""

    name: str
    what: str
    options: Mapping[str, str]


def formats(host: PluginHost) -> list[Format]:
    """All formats of the registered exporters, by name."""
    found = []
    for exporter in host.exporters():
        lines = (type(exporter).__doc__ or "").strip().splitlines()
        takes = exporter.options if isinstance(exporter, AdjustableExporter) else {}
        found.append(Format(exporter.name, lines[0] if lines else "", dict(takes)))
    return found


def export_map(
    folder: Path | str,
    to: str,
    out: Path | str | None = None,
    options: Mapping[str, str] | None = None,
    force: bool = False,
    host: PluginHost | None = None,
) -> list[Path]:
    """Write the map of a folder in the format `to` and return the files written.

    - `out`: a file's name, or a folder for formats of several files; by default the map's name
      with the format's suffix, in the current folder.
    - `options`: what the format takes, see `formats`. `force`: replace files that are there.

    Raises `PluginError` for unknown formats and options, `MapError` where the map can't be read or
    a file can't be written; then nothing has been written.
    """
    exporter = _exporter(host or PluginHost(), to, options or {})
    stored = load(folder)
    name = stored.folder.resolve().name
    try:
        with tempfile.TemporaryDirectory(prefix="afkb-export-") as scratch:
            files = _written(exporter, stored, Path(scratch))
            several = name if len(files) == 1 else f"{name}-{to}"
            target = None if out is None else Path(out).expanduser()
            return deliver(files, Path(scratch), target, several, force)
    except OSError as error:
        where = error.filename or out or Path.cwd()
        raise MapError(
            f"{where}: can't write the export ({error.strerror or error}); name another --out"
        ) from error


def _exporter(host: PluginHost, name: str, options: Mapping[str, str]) -> Exporter:
    exporter = host.exporters([name])[0]
    if not options:
        return exporter
    if not isinstance(exporter, AdjustableExporter):
        raise PluginError(f"format {name!r} takes no options, and {', '.join(options)} is given")
    return exporter.with_options(options)


def _written(exporter: Exporter, stored: StoredMap, scratch: Path) -> Sequence[Path]:
    run = run_of(stored.folder)
    try:
        if isinstance(exporter, SceneExporter):
            turtle = (stored.folder / SCENE_FILE).read_bytes()
            return list(exporter.export_scene(turtle, scratch, run))
        return list(exporter.export(read_map(stored), scratch, run))
    except (AfkbError, OSError):
        raise
    except Exception as error:
        raise PluginError(
            f"exporter {exporter.name!r} failed with {type(error).__name__}: {error}; "
            "mend it, or choose another format"
        ) from error
