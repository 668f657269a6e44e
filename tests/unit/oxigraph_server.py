"""A real Oxigraph server in a process of its own, that can be killed and started again."""

from __future__ import annotations

import shutil
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from urllib.request import ProxyHandler, build_opener

import pytest


def binary() -> str:
    beside = shutil.which("oxigraph", path=str(Path(sys.executable).parent))
    found = beside or shutil.which("oxigraph") or _of_the_package()
    if found is None:
        pytest.skip("no oxigraph server here; `pip install oxigraph` brings one")
    return found


def _of_the_package() -> str | None:
    from importlib.metadata import PackageNotFoundError, files

    with suppress(PackageNotFoundError):
        for file in files("oxigraph") or []:
            if file.name == "oxigraph":
                return str(file.locate())
    return None


class OxigraphServer:
    """On a free port of this machine, its data in a folder."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            self.port = free.getsockname()[1]
        self.url = f"http://127.0.0.1:{self.port}"
        self.process: subprocess.Popen[bytes] | None = None

    def start(self) -> None:
        command = [binary(), "serve", "--location", self.folder, "--bind", f"127.0.0.1:{self.port}"]
        self.process = subprocess.Popen(
            command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
        )
        opener = build_opener(ProxyHandler({}))
        for _ in range(200):
            with suppress(OSError), opener.open(self.url + "/query?query=ASK%7B%7D", timeout=5):
                return
            time.sleep(0.05)
        raise AssertionError("the oxigraph server does not answer")

    def kill(self) -> None:
        """As a power cut does."""
        if self.process is not None:
            self.process.kill()
            self.process.wait()
            self.process = None


@contextmanager
def oxigraph_server(folder: Path) -> Iterator[OxigraphServer]:
    server = OxigraphServer(folder)
    server.start()
    try:
        yield server
    finally:
        server.kill()
