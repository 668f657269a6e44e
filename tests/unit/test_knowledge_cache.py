import multiprocessing
import os
import pickle
import threading
from pathlib import Path

import pytest

from afkb.errors import KnowledgeError
from afkb.knowledge import AfNet, bundled_ontology, cache
from afkb.ontology.writing import one_writer, put_whole


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("AFKB_CACHE", str(tmp_path / "cache"))
    return tmp_path / "cache"


def test_what_was_read_once_is_not_read_again(folder: Path) -> None:
    calls: list[int] = []

    def make() -> str:
        calls.append(1)
        return "made"

    assert [cache.cached("thing", "key", make) for _ in range(3)] == ["made"] * 3
    assert len(calls) == 1


def test_the_key_is_the_content_and_not_the_name_or_the_time(tmp_path: Path) -> None:
    a, b = tmp_path / "one" / "my.yaml", tmp_path / "two" / "my.yaml"
    for path in (a, b):
        path.parent.mkdir()
        path.write_text("extension: my")
    os.utime(a, (1, 1))
    assert cache.content_key([a]) == cache.content_key([b])
    b.write_text("extension: mine")
    assert cache.content_key([a]) != cache.content_key([b])


@pytest.mark.parametrize("broken", [b"", b"no pickle", pickle.dumps("made")[:-3]])
def test_a_broken_entry_is_made_again(folder: Path, broken: bytes) -> None:
    cache.cached("thing", "key", lambda: "old")
    (folder / "thing-key.pickle").write_bytes(broken)
    assert cache.cached("thing", "key", lambda: "new") == "new"
    assert cache.cached("thing", "key", lambda: "newer") == "new"


def test_a_folder_that_cannot_be_made_is_no_error(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("AFKB_CACHE", str(tmp_path / "file" / "cache"))
    assert cache.cached("thing", "key", lambda: 7) == 7
    assert cache.cached_file("thing.nt", "key", lambda: b"x") is None


def test_entries_that_nobody_used_for_a_month_go(folder: Path) -> None:
    cache.cached("old", "key", lambda: 1)
    os.utime(folder / "old-key.pickle", (1, 1))
    cache.cached("new", "key", lambda: 2)
    assert [p.name for p in folder.iterdir()] == ["new-key.pickle"]


def _read(_: int) -> tuple[int, int]:
    base = AfNet.load()
    return len(base.categories), len(base.afbits)


def test_processes_that_start_at_once_read_the_same(folder: Path) -> None:
    with multiprocessing.get_context("spawn").Pool(4) as pool:
        found = set(pool.map(_read, range(8)))
    assert len(found) == 1
    assert not [p for p in folder.iterdir() if p.name.startswith(".writing")]


def test_threads_share_a_base(folder: Path) -> None:
    base = AfNet()
    found: list[int] = []
    threads = [threading.Thread(target=lambda: found.append(id(base.categories))) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(set(found)) == 1


def _write(arguments: tuple[str, str]) -> None:
    path, letter = Path(arguments[0]), arguments[1]
    with one_writer(path):
        put_whole(path, letter * 100_000)


def test_many_readers_never_meet_half_of_what_writers_write(tmp_path: Path) -> None:
    path = tmp_path / "afnet.owl"
    put_whole(path, "a" * 100_000)
    stop = threading.Event()
    met: set[tuple[int, str]] = set()

    def read() -> None:
        while not stop.is_set():
            text = path.read_text()
            met.add((len(text), "".join(sorted(set(text)))))

    readers = [threading.Thread(target=read) for _ in range(3)]
    for reader in readers:
        reader.start()
    with multiprocessing.get_context("spawn").Pool(4) as pool:
        pool.map(_write, [(str(path), letter) for letter in "bcdefghi"])
    stop.set()
    for reader in readers:
        reader.join()
    assert {length for length, _ in met} == {100_000}
    assert all(len(letters) == 1 for _, letters in met)
    assert [p.name for p in tmp_path.iterdir() if p.name != path.name] in (
        [],
        [".afnet.owl.lock"],
    )


def test_a_second_writer_is_told_who_is_in_the_way(tmp_path: Path) -> None:
    path = tmp_path / "afnet.owl"
    with (
        one_writer(path),
        pytest.raises(KnowledgeError, match=r"afnet\.owl: another process has been writing it"),
        one_writer(path, patience_s=0.2),
    ):
        pass


def test_a_write_that_fails_leaves_the_old_file(tmp_path: Path) -> None:
    path = tmp_path / "afnet.owl"
    put_whole(path, "old")
    with pytest.raises(UnicodeEncodeError):
        put_whole(path, "\ud800")
    assert path.read_text() == "old"
    assert [p.name for p in tmp_path.iterdir()] == ["afnet.owl"]


def test_a_second_start_takes_the_bundled_ontology_from_the_cache(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    first = AfNet.load()
    monkeypatch.setattr("afkb.knowledge.base.read_content", lambda files: pytest.fail("read again"))
    again = AfNet.load()
    assert again.categories["Mug"] == first.categories["Mug"]
    assert again.files == (bundled_ontology(),)
