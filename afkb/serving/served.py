"""What is served at the moment: maps in the processes that answer, and the files they came from."""

from __future__ import annotations

import asyncio
import hashlib
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path

from afkb.errors import AfkbError
from afkb.serving.channel import ASKING, TELLING, Head
from afkb.serving.limits import Limits
from afkb.serving.pool import Keeper, Pool

_LOOK_S = 1.0
"""So often the disk is looked at for maps that were written anew."""
_WHYS_KEPT = 64


class Edition:
    """The maps as they were at one moment, with the processes that hold them."""

    def __init__(self, keeper: Keeper, told: Head, version: str, limits: Limits) -> None:
        self.version = version
        self.maps: list[Head] = told["maps"]
        self.graphs: list[str] = told["graphs"]
        self.keeper = keeper
        self.asking = Pool(keeper, ASKING, limits.workers, limits.seconds, limits)
        self._telling = Pool(keeper, TELLING, 1, limits.telling_s, limits)
        self._told: dict[tuple[str, str | None], asyncio.Task[tuple[Head, bytes]]] = {}

    async def tell(self, name: str, node: str | None = None) -> tuple[Head, bytes]:
        """The drawing of a map, or why a node is in it; asked once, kept for the next who asks."""
        key = (name, node)
        task = self._told.get(key)
        if task is None:
            head = {"map": name} | ({"node": node} if node is not None else {})
            task = self._told[key] = asyncio.create_task(self._telling.ask(head))
            task.add_done_callback(lambda done: self._keep(key, done))
        return await asyncio.shield(task)

    def _keep(self, key: tuple[str, str | None], done: asyncio.Task[tuple[Head, bytes]]) -> None:
        """Keep drawings and the latest explanations; what failed is tried again when asked."""
        if done.cancelled() or done.exception() or done.result()[0]["status"] != 200:
            self._told.pop(key, None)
        explained = [k for k, task in self._told.items() if k[1] is not None and task.done()]
        for old in explained[:-_WHYS_KEPT]:
            del self._told[old]


class Served:
    """The current edition; maps that change on disk become a new one, without a pause."""

    def __init__(
        self,
        folders: Sequence[Path],
        ontology: Sequence[Path],
        limits: Limits,
        tell: Callable[[str], None],
    ) -> None:
        self._folders = [folder.resolve() for folder in folders]
        self._ontology = list(ontology)
        self.limits = limits
        self._tell = tell
        self._tried = ""
        self._old: list[tuple[float, Edition]] = []
        self.now: Edition

    async def open(self) -> None:
        """Load the maps; `MapError` where one can't be read."""
        self.now = await self._load(self._on_disk())

    async def watch(self) -> None:
        """Load the maps anew whenever they change on disk, until cancelled."""
        while True:
            await asyncio.sleep(_LOOK_S)
            self._close_old()
            version = self._on_disk()
            if self.now.keeper.is_gone or version not in (self.now.version, self._tried):
                await self._renew(version)

    async def _renew(self, version: str) -> None:
        self._tried = version
        try:
            new = await self._load(version)
        except (AfkbError, OSError) as error:
            self._tell(f"a map changed on disk and can't be read; the old one is served: {error}")
            return
        loop = asyncio.get_running_loop()
        drained = loop.time() + max(self.limits.seconds, self.limits.telling_s) + 1.0
        self._old.append((drained, self.now))
        self.now = new
        self._tell("the maps changed on disk and were loaded anew")

    async def _load(self, version: str) -> Edition:
        keeper = Keeper(self._folders, self._ontology, self.limits)
        try:
            told = await asyncio.to_thread(keeper.ready)
        except BaseException:
            keeper.close()
            raise
        return Edition(keeper, told, version, self.limits)

    def _close_old(self) -> None:
        """End earlier editions, once nobody can still be asking them."""
        time = asyncio.get_running_loop().time()
        for drained, edition in list(self._old):
            if time > drained:
                self._old.remove((drained, edition))
                edition.keeper.close()

    def _on_disk(self) -> str:
        """A name for the maps' RDF as it is now; another where one was written anew."""
        found = hashlib.sha256()
        for file in (file for folder in self._folders for file in sorted(folder.glob("*.ttl"))):
            with suppress(FileNotFoundError):  # It is being replaced this very moment.
                state = file.stat()
                told = (file, state.st_dev, state.st_ino, state.st_mtime_ns, state.st_size)
                found.update(repr(told).encode())
        return found.hexdigest()[:16]

    def close(self) -> None:
        """End every process."""
        for _, edition in self._old:
            edition.keeper.close()
        if hasattr(self, "now"):
            self.now.keeper.close()
