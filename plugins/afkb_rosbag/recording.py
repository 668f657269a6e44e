"""A bag's messages: opened through `rosbags`, streamed, their headers read without decoding."""

from __future__ import annotations

import struct
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rosbags.highlevel import AnyReader
from rosbags.interfaces import Connection
from rosbags.typesys import Stores, get_typestore

from afkb.errors import BadFrame, SourceError

_MAGIC = {".bag": b"#ROSBAG V", ".mcap": b"\x89MCAP0\r\n", ".db3": b"SQLite format 3\0"}
_REPAIR = "if it was cut short, repair it first (`mcap recover`, `rosbag reindex`)"


@dataclass(frozen=True, slots=True)
class Header:
    """A message's stamp (ns) and frame; where the stamp is unset, the time of recording."""

    stamp: int
    frame_id: str


def bag_paths(path: Path) -> list[Path]:
    """What to hand to the reader: the file, the ROS 2 folder, or the files a folder holds."""
    if not path.is_dir() or (path / "metadata.yaml").is_file():
        return [path]
    for ending in (".mcap", ".db3", ".bag"):
        files = sorted(path.glob(f"*{ending}"))
        if len(files) == 1 or (files and ending == ".bag"):
            return files
        if files:
            raise SourceError(
                f"{path}: {len(files)} *{ending} files and no metadata.yaml; name one of them, or "
                "write the metadata with `ros2 bag reindex`"
            )
    raise SourceError(f"{path}: metadata.yaml is missing and so are its bag files")


@contextmanager
def opened(path: Path) -> Iterator[AnyReader]:
    """The open reader; `SourceError` where the file is not a readable bag."""
    reader = _open(path)
    try:
        yield reader
    finally:
        reader.close()


def _open(path: Path) -> AnyReader:
    # Bags from before ROS 2 Iron carry no message definitions; these messages never changed.
    store = get_typestore(Stores.ROS2_HUMBLE)
    paths = bag_paths(path)
    for file in paths:
        _check_magic(file)
    try:
        reader = AnyReader(paths, default_typestore=store)
        reader.open()
    except Exception as error:  # rosbags lets errors of struct, codecs, YAML and SQLite through
        raise _unreadable(path, error) from error
    return reader


def _check_magic(path: Path) -> None:
    """Raise `SourceError` where a file does not begin as its name promises."""
    magic = _MAGIC.get(path.suffix)
    if magic is None or not path.is_file():
        return
    with path.open("rb") as file:
        if file.read(len(magic)) != magic:
            raise SourceError(
                f"{path}: not a readable bag: it does not begin as a *{path.suffix} file does; "
                "copy it again from where it was recorded"
            )


def messages(
    reader: AnyReader,
    path: Path,
    connections: Sequence[Connection],
    start: int | None = None,
    stop: int | None = None,
) -> Iterator[tuple[Connection, int, bytes]]:
    """Messages with their time of recording (ns); `SourceError` where the file breaks off."""
    stream = reader.messages(connections, start=start, stop=stop)
    while True:
        try:
            item = next(stream)
        except StopIteration:
            return
        except Exception as error:  # as in _open
            raise _unreadable(path, error) from error
        yield item


def decoded(reader: AnyReader, connection: Connection, raw: bytes) -> Any:
    """The message; `BadFrame` where its bytes are not what its type says."""
    try:
        return reader.deserialize(raw, connection.msgtype)
    except Exception as error:  # as in _open
        raise BadFrame(f"{connection.topic}: message does not decode ({_line(error)})") from error


def _unreadable(path: Path, error: Exception) -> SourceError:
    return SourceError(f"{path}: not a readable bag: {_line(error)}; {_REPAIR}")


def _line(error: Exception) -> str:
    return " ".join(str(error).split()) or type(error).__name__


def header_of(raw: bytes | memoryview, received: int, is_ros2: bool) -> Header:
    """The `std_msgs/Header` that a raw message begins with; `received` is when it was recorded, ns.

    Reading 20 bytes in place of decoding the message is what lets an hour of images be indexed.
    """
    if len(raw) < 16:  # too short to be what it says; decoding it will tell
        return Header(received, "")
    order = "<" if not is_ros2 or raw[1] & 1 else ">"
    seconds, nanoseconds, length = struct.unpack_from(f"{order}III", raw, 4)
    frame_id = bytes(raw[16 : 16 + length]).rstrip(b"\0").decode("utf-8", "replace")
    stamp = seconds * 1_000_000_000 + nanoseconds
    return Header(stamp or received, frame_id.lstrip("/"))


def stamp_ns(message: Any, received: int = 0) -> int:
    """Stamp of a decoded stamped message, ns; `received` where it is unset."""
    stamp = message.header.stamp
    return int(stamp.sec * 1_000_000_000 + stamp.nanosec) or received


def of_type(connections: Sequence[Connection], *types: str) -> list[Connection]:
    """Connections that carry one of the types, by topic."""
    return sorted((c for c in connections if c.msgtype in types), key=lambda c: c.topic)
