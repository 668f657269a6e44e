"""Writes a map folder: everything in it, or nothing."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path

from afkb.errors import MapError
from afkb.flow import TopologicalMap
from afkb.plugins.protocols import Exporter
from afkb.store.folder import carry_over, check_out, put_in_place, scratch_beside
from afkb.store.scene import scene_base, scene_triples
from afkb.store.scribe import Names
from afkb.store.shapes import map_json
from afkb.store.stored import RUN_FILE, SCENE_FILE, StoredMap, load, read_scene
from afkb.store.turtle import to_turtle

STATE = "state"
# The report shows run.json as it is where a browser lets it do no more: figures come first.
_TOLD_FIRST = ("frames_per_second", "peak_memory_mb", "seconds")


def write_map(
    folder: Path | str,
    topological_map: TopologicalMap,
    run: Mapping[str, object],
    exporters: Sequence[Exporter],
    knowledge_base: Names,
    update: bool = False,
    state: Mapping[str, bytes] | None = None,
) -> Path:
    """Write a map folder in one step and return its path; a map that was there is replaced.

    - `run`: what run.json holds; `T_map_source` and the list of files are added.
    - `exporters`: those with `in_map_folder` write into the folder; the others are left alone.
    - `update`: a later visit to the map that stands there: its things keep their IRIs, and state
      that is not given anew is kept.
    - `state`: files for `state/`, by name.

    Everything but run.json (and what exporters document) is the same for the same map, byte for
    byte. Whenever the process is killed, the folder is the old map or the new one, whole.
    `MapError` where it can't be written or something else is there.
    """
    folder = check_out(folder)
    earlier = load(folder) if update else None
    base = earlier.base if earlier else scene_base(topological_map, knowledge_base)
    scene = to_turtle(scene_triples(topological_map, base, knowledge_base, run), base)
    run = {**run, "T_map_source": topological_map.T_map_source.tolist()}
    try:
        with scratch_beside(folder) as scratch:
            _write_own(scratch, folder, scene, _kept_state(earlier) | dict(state or {}))
            for exporter in exporters:
                if exporter.in_map_folder:
                    exporter.export(topological_map, scratch, run)
            _write_run(scratch, run)
            if folder.exists():
                carry_over(folder, scratch, _written_before(folder))
            put_in_place(scratch, folder)
    except OSError as error:
        raise MapError(f"{folder}: can't write the map ({error.strerror or error})") from error
    return folder


def _write_own(scratch: Path, folder: Path, scene: bytes, state: Mapping[str, bytes]) -> None:
    (scratch / SCENE_FILE).write_bytes(scene)
    stored = StoredMap(folder, read_scene(scene))
    (scratch / "map.json").write_text(map_json(stored), encoding="utf-8")
    (scratch / STATE).mkdir()
    for name, content in sorted(state.items()):
        target = scratch / STATE / name
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes(content)


def _write_run(scratch: Path, run: Mapping[str, object]) -> None:
    files = sorted({RUN_FILE, *(entry.name for entry in scratch.iterdir())})
    first = {key: run[key] for key in _TOLD_FIRST if key in run}
    told = {**first, **run, "files": files}
    text = json.dumps(told, indent=2, ensure_ascii=False, default=str)
    (scratch / RUN_FILE).write_text(text + "\n", encoding="utf-8")


def _kept_state(earlier: StoredMap | None) -> dict[str, bytes]:
    if earlier is None:
        return {}
    root = earlier.folder / STATE
    return {
        path.relative_to(root).as_posix(): path.read_bytes()
        for path in sorted(root.rglob("*"))
        if path.is_file()
    }


def _written_before(folder: Path) -> frozenset[str]:
    """Names of the files that afkb wrote there; run.json lists them."""
    own = {SCENE_FILE, "map.json", RUN_FILE, STATE}
    try:
        listed = json.loads((folder / RUN_FILE).read_text(encoding="utf-8")).get("files", [])
    except (OSError, ValueError, AttributeError):
        # A map without a readable run.json is still a map; what it lists is then unknown.
        listed = []
    return frozenset(own) | frozenset(str(name) for name in listed)
