import csv
import json
from pathlib import Path

import pytest

from bench.inference.__main__ import PARTS
from bench.inference.contents import asked, hidden_in_turn, network_of_rows
from bench.inference.rooms import EVIDENCE, SEVEN
from bench.inference.tables import read_table
from bench.part_by_part import run_parts

HEADER = ["building", "viewpoint", "class_id", "class_inferred", "objects"]
SEEN = {
    "bedroom": "bed:1|lamp:1",
    "kitchen": "stove:1|refrigerator:1",
    "bathroom": "toilet:1|bathtub:1",
    "hallway": "picture:2",
}


def write(path: Path, rooms: dict[str, str], copies: int) -> Path:
    with path.open("w", newline="", encoding="utf-8") as file:
        rows = csv.writer(file)
        rows.writerow(HEADER)
        for i in range(copies):
            for room, objects in rooms.items():
                rows.writerow([f"home{i % 3}", f"{path.stem}-{room}-{i}", "0", room, objects])
    return path


def run(words: list[str], capsys: pytest.CaptureFixture[str]) -> tuple[int, str, str]:
    status = run_parts("bench.inference", PARTS, None, words)
    said = capsys.readouterr()
    return status, said.out, said.err


def test_every_row_gets_a_posterior(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    train = write(tmp_path / "train.csv", SEEN, 90)
    judged = write(tmp_path / "asked.csv", SEEN | {"office": "", "porch": "unheard of:1"}, 1)
    status, out, _ = run(["rooms", str(judged), "--train", str(train), "--json"], capsys)
    result = json.loads(out)["rooms"]
    assert status == 0
    assert [row["row"] for row in result["rows"]] == [f"asked-{r}-0" for r in
                                                     (*SEEN, "office", "porch")]  # fmt: skip
    for row in result["rows"]:
        for evidence in EVIDENCE:
            assert sum(row[evidence].values()) == pytest.approx(1, abs=1e-5)
            assert set(row[evidence]) < set(SEVEN)
    assert (
        max(result["rows"][0]["categories"], key=result["rows"][0]["categories"].get) == "Bedroom"
    )
    assert result["rows"][4]["categories"] == result["rows"][5]["categories"]
    assert result["scores"]["categories"]["accuracy"] == 1.0


def test_a_table_without_training_rows_is_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    judged = write(tmp_path / "asked.csv", SEEN, 1)
    status, _, err = run(["rooms", str(judged)], capsys)
    assert (status, err) == (1, "rooms: name the rows to count with --train FILE\n")
    status, _, err = run(["rooms", str(judged), "--train", str(tmp_path / "no.csv")], capsys)
    assert status == 1
    assert "no such table of rooms" in err


def test_what_is_hidden_is_told_by_the_rest_of_the_room(tmp_path: Path) -> None:
    path = tmp_path / "rooms.csv"
    with path.open("w", newline="", encoding="utf-8") as file:
        rows = csv.writer(file)
        rows.writerow(["scene", "region", "category_by_votes", "objects"])
        for i in range(40):
            odd = ["Unknown room", "thing a:1|thing b:1|wall:4"]
            rows.writerow([f"s{i % 5}", f"{i}-a", *(odd if i % 2 else ["Bedroom", "bed:1|wall:4"])])
    table = asked(read_table(path, None))
    network = network_of_rows(table)
    a, bed = hidden_in_turn(network, table.rows[1:2], ["thing a", "bed"])[0]
    other_a, _ = hidden_in_turn(network, table.rows[:1], ["thing a", "bed"])[0]
    assert a > 0.8 > 0.2 > other_a
    assert bed < 0.5
