"""How much a question may take: time, memory, bytes, and how many may ask at once."""

from __future__ import annotations

from dataclasses import dataclass

MB = 1 << 20


@dataclass(frozen=True, slots=True)
class Limits:
    """The bounds of one server; whatever exceeds one is refused with a status that says so.

    - `seconds`: how long a query may run; then its process is killed.
    - `memory_mb`: what a query may take beyond what the maps take (address space, Linux).
    - `answer_mb`: the largest answer. `request_kb`: the largest query.
    - `workers`: queries that run at once. `waiting`: queries that wait for one of them, at most
      `patience_s`; further ones are told to come again.
    - `connections`: open connections. `header_s`, `upload_s`: how long a client may take to send
      its headers and its query; `stalled_s`: how long it may stop reading its answer.
    - `telling_s`: how long drawing or explaining may take, which runs no stranger's query.
    - `outgoing_mb`: answers that are on their way to slow clients, all together.
    """

    seconds: float = 10.0
    memory_mb: int = 512
    answer_mb: int = 16
    request_kb: int = 1024
    workers: int = 2
    waiting: int = 64
    patience_s: float = 5.0
    connections: int = 256
    header_s: float = 10.0
    upload_s: float = 10.0
    stalled_s: float = 20.0
    telling_s: float = 60.0
    outgoing_mb: int = 128
