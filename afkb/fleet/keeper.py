"""Sends maps to a server as they come, and loses no hour on a server that is gone."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path

from afkb.errors import EndpointError
from afkb.fleet.names import named
from afkb.fleet.pushing import Pushed, push
from afkb.fleet.server import PATIENCE_S, Server
from afkb.store import load
from afkb.store.http import Address, PassingTrouble


@dataclass(slots=True, eq=False)
class Keeper:
    """A server that keeps the maps of a run or a batch, found when it is needed.

    It may be away while maps are made. Where it stays away for `patience_s`, the maps after that
    are tried once each.
    """

    url: str
    prefix: str
    tell: Callable[[str], None]
    patience_s: float = PATIENCE_S
    _server: Server | None = field(default=None, repr=False)

    @classmethod
    def of(cls, url: str, prefix: str, tell: Callable[[str], None]) -> Keeper:
        """The keeper at a URL, after a look whether that can work, before hours of mapping.

        Raises `EndpointError` for what is no server's URL, speaks no SPARQL or refuses; a server
        that is away now is only told of.
        """
        keeper = cls(url, prefix, tell)
        try:
            keeper._server = replace(Server.find(url, None, 0.0, tell), patience_s=PATIENCE_S)
        except PassingTrouble as trouble:
            tell(f"note: {trouble}; maps are made, and sent when it is there")
        return keeper

    def keep(self, folder: Path, name: str | None = None) -> Pushed:
        """Have the server keep a map, by its folder's name unless another is given.

        Raises `EndpointError` where it does not, with what to do once it does again.
        """
        (called,) = named([folder], name, self.prefix)
        try:
            if self._server is None:
                self._server = Server.find(self.url, None, self.patience_s, self.tell)
            return push(replace(self._server, patience_s=self.patience_s), load(folder), called)
        except EndpointError as error:
            self.patience_s = 0.0
            prefix = f" --prefix {self.prefix}" if self.prefix else ""
            plain = Address.read(self.url).url
            raise EndpointError(
                f"{error}; send it later: afkb store push {folder}{prefix} --url {plain}"
            ) from error
