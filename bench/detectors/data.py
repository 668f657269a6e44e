"""What a benchmark is asked to look at: folders of recordings, and what was seen in them."""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

from afkb.errors import AfkbError
from afkb.plugins.host import PluginHost
from bench.detectors.kitchen import Kitchen
from bench.detectors.seen import Run, placed_views, run_detectors

ROOT = Path(__file__).parents[2]


class NoData(AfkbError):
    """A folder that a part needs is not there, or holds something else."""


def data_folder() -> Path:
    """The folder of recordings: AFKB_DATA, else shared/data beside the repository."""
    return Path(os.environ.get("AFKB_DATA", ROOT.parent / "shared" / "data"))


@dataclass
class Home:
    """A recorded home with its truth: `bag/` and `truth.json` (form of the README of the data).

    `seen` is what all detectors say of it at its true poses; made once for all parts.
    """

    folder: Path
    host: PluginHost
    stride: int = 1
    detectors: Sequence[str] = ()

    @property
    def name(self) -> str:
        """Its folder's name."""
        return self.folder.name

    @cached_property
    def truth(self) -> dict[str, Any]:
        """`views` with stamp and pose, `things` with category, box, and how well they are seen."""
        content: dict[str, Any] = json.loads((self.folder / "truth.json").read_text())
        return content

    def views(self) -> Any:
        """Its views at their true poses."""
        source = self.host.open_source(str(self.folder / "bag"))
        return placed_views(source.views(stride=self.stride), self.truth)

    @cached_property
    def seen(self) -> Run:
        """Every detection in it, by view."""
        return run_detectors(self.views(), self.host.detectors(self.detectors))


def homes_in(
    folder: Path, host: PluginHost, stride: int = 1, detectors: Sequence[str] = ()
) -> list[Home]:
    """The homes of a folder, or the one home that it is."""
    folders = [folder, *sorted(folder.iterdir())] if folder.is_dir() else []
    found = [f for f in folders if (f / "truth.json").is_file() and (f / "bag").exists()]
    if not found:
        raise NoData(f"no home (bag/ and truth.json) at {folder}; name one with --homes")
    return [Home(f, host, stride, detectors) for f in found]


@dataclass
class Asked:
    """The data folders, every how manieth view is looked at, and where pictures go."""

    homes_folder: Path
    mosd: Path
    redkitchen: Path
    stride: int = 1
    pictures: Path | None = None
    detectors: Sequence[str] = ()
    """Names of the detectors to run; none are the default ones."""
    host: PluginHost = field(default_factory=PluginHost)

    @cached_property
    def homes(self) -> list[Home]:
        """The homes; what was seen in them is kept for the parts that follow."""
        return homes_in(self.homes_folder, self.host, self.stride, self.detectors)

    @cached_property
    def kitchen(self) -> Kitchen:
        """The real kitchen; what was seen in it is kept for the parts that follow."""
        return Kitchen(self.redkitchen, self.host, self.stride, tuple(self.detectors))

    def check(self, needs: Sequence[str]) -> None:
        """Raises `NoData` where a folder that a part needs is missing."""
        if "homes" in needs:
            _ = self.homes
        for name in ("mosd", "redkitchen"):
            folder: Path = getattr(self, name)
            if name in needs and not folder.is_dir():
                raise NoData(f"no {name} at {folder}; name it with --{name}, or set AFKB_DATA")
