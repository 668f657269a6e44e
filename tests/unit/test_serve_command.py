"""`afkb serve` from its start to its end."""

from __future__ import annotations

import json
import signal
import socket
import subprocess
import sys
import urllib.request
from pathlib import Path

import pytest

from afkb.errors import AfkbError
from afkb.serving.errors import ServingError
from afkb.serving.limits import Limits
from afkb.serving.running import Address, serve
from afkb.store import write_map
from store_samples import Names, sample_map


@pytest.fixture(scope="module")
def home(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_map(tmp_path_factory.mktemp("maps") / "home", sample_map(), {}, [], Names())


def test_it_tells_where_it_answers_and_ends_cleanly(home: Path) -> None:
    command = [sys.executable, "-m", "afkb.cli.app", "serve", str(home), "--port", "0", "--json"]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    assert process.stdout is not None
    told = json.loads(process.stdout.readline())
    with urllib.request.urlopen(
        f"{told['sparql']}?query=ASK%7B%3Fc%20a%20afn:RoomCategory%7D"
    ) as found:
        assert json.load(found)["boolean"] is True
    process.send_signal(signal.SIGINT)
    _, said = process.communicate(timeout=20)
    assert process.returncode == 0
    assert said.splitlines() == ["stopped"]


def refused(folder: Path, address: Address) -> str:
    with pytest.raises(AfkbError) as raised:
        serve([folder], [], address, Limits(), lambda *_: None, lambda _: None)
    return str(raised.value)


def test_a_port_in_use_is_told_in_one_line(home: Path) -> None:
    with socket.create_server(("127.0.0.1", 0)) as other:
        port = other.getsockname()[1]
        with pytest.raises(ServingError, match=f"port {port} is in use; choose another with"):
            serve([home], [], Address(port=port), Limits(), lambda *_: None, lambda _: None)


def test_an_address_of_another_machine_is_told_in_one_line(home: Path) -> None:
    assert "192.0.2.1" in refused(home, Address("192.0.2.1", 0))


def test_a_folder_that_is_no_map_is_told_before_anything_is_served(tmp_path: Path) -> None:
    assert "no such map" in refused(tmp_path / "none", Address(port=0))
