"""Finds and reads world files; what is wrong in one is said in one line."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import yaml
from pydantic import ValidationError

from afkb.errors import SourceError
from afkb_simulation.checks import check_world
from afkb_simulation.world_file import WorldFile

_BUNDLED = Path(__file__).parent / "worlds"
_SUFFIX = ".world.yaml"


class _Loader(yaml.SafeLoader):
    """YAML whose `on` is a word and `1e-3` a number, as in YAML 1.2."""


_BOOL = "tag:yaml.org,2002:bool"
_Loader.yaml_implicit_resolvers = {
    first: [(tag, pattern) for tag, pattern in resolvers if tag != _BOOL]
    for first, resolvers in yaml.SafeLoader.yaml_implicit_resolvers.items()
}
_Loader.add_implicit_resolver(
    "tag:yaml.org,2002:float",
    re.compile(r"^[-+]?(?:\d+\.?\d*|\.\d+)[eE][-+]?\d+$"),
    list("-+.0123456789"),
)
_Loader.add_implicit_resolver(_BOOL, re.compile(r"^(?:true|false)$"), list("tf"))


def bundled_worlds() -> dict[str, Path]:
    """The worlds that come with the package: name to file."""
    return {p.name.removesuffix(_SUFFIX): p for p in sorted(_BUNDLED.glob(f"*{_SUFFIX}"))}


def world_path(uri: str) -> Path:
    """The file behind a path or `world:NAME`; `SourceError` for a name that isn't bundled."""
    if not uri.startswith("world:"):
        return Path(uri)
    worlds = bundled_worlds()
    name = uri.removeprefix("world:")
    if name not in worlds:
        raise SourceError(f"{uri}: no such bundled world; bundled: {', '.join(sorted(worlds))}")
    return worlds[name]


def read_world(uri: str) -> WorldFile:
    """The world behind a path or `world:NAME`, checked; `SourceError` says what to mend."""
    path = world_path(uri)
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", None) or "not UTF-8 text"
        raise SourceError(f"{path}: can't be read: {reason}; give a readable file") from error
    world = _validated(_parsed(text, path), path)
    check_world(world, path)
    return world


def _parsed(text: str, path: Path) -> Mapping[str, Any]:
    try:
        data = yaml.load(text, Loader=_Loader)
    except (yaml.YAMLError, RecursionError, ValueError) as error:
        mark = getattr(error, "problem_mark", None)
        where = f" line {mark.line + 1}, column {mark.column + 1}" if mark else ""
        problem = getattr(error, "problem", None) or "unreadable"
        raise SourceError(f"{path}:{where} not YAML: {problem}; mend that line") from error
    if not isinstance(data, Mapping):
        raise SourceError(f"{path}: holds no mapping; start it with `name:` (docs/worlds.md)")
    return data


def _validated(data: Mapping[str, Any], path: Path) -> WorldFile:
    try:
        # JSON mode: strict about numbers and words, yet takes YAML's lists for tuples
        return WorldFile.model_validate_json(_as_json(data, path))
    except ValidationError as error:
        found = error.errors()[0]
        key = _key_path(found["loc"], data)
        raise SourceError(f"{path}: {key}: {_mend(found['type'], found['msg'])}") from error


def _as_json(data: Mapping[str, Any], path: Path) -> str:
    try:
        return json.dumps(data, default=str)
    except (ValueError, TypeError, RecursionError) as error:
        raise SourceError(f"{path}: holds itself or an odd key ({error}); write it out") from error


def _key_path(loc: tuple[int | str, ...], data: object) -> str:
    """`things[3] (mug_1).size` for a location in the file."""
    text = ""
    for part in loc:
        if isinstance(part, int):
            data = data[part] if isinstance(data, list) and part < len(data) else None
            name = data.get("name") if isinstance(data, Mapping) else None
            text += f"[{part}]" + (f" ({name})" if name else "")
        else:
            data = data.get(part) if isinstance(data, Mapping) else None
            text += f".{part}" if text else part
    return text or "the file"


def _mend(kind: str, message: str) -> str:
    if kind == "missing":
        return "is missing; add it (docs/worlds.md lists the keys)"
    if kind == "extra_forbidden":
        return "no such key; remove it or mend its spelling (docs/worlds.md lists the keys)"
    message = message.removeprefix("Value error, ")
    return message[0].lower() + message[1:] + ("" if ";" in message else "; mend the value")
