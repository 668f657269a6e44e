"""The page of all measurements says what their results say, and names no folder of a machine."""

from __future__ import annotations

import re
import shlex
from dataclasses import replace
from importlib import import_module
from pathlib import Path

import pytest

from bench.evaluation.chapters import MEASUREMENTS, Measurement
from bench.evaluation.measuring import NotMeasured, measured
from bench.evaluation.results import FOLDER, Result, spread
from bench.evaluation.writing import PAGE, page

ROOT = Path(__file__).parents[2]


def test_the_page_is_what_the_results_give() -> None:
    assert PAGE.read_text(encoding="utf-8") == page(), "run: python -m bench.evaluation write"


@pytest.mark.parametrize("path", sorted(FOLDER.glob("*.json")), ids=lambda p: p.stem)
def test_a_result_names_no_folder_of_the_machine(path: Path) -> None:
    assert path.stem in MEASUREMENTS
    assert not re.search(r'[\s"(](/home|/root|/tmp|/work|/mnt|/usr)/', path.read_text())


@pytest.mark.parametrize("asked", MEASUREMENTS.values(), ids=lambda m: m.name)
def test_each_measurement_is_a_command_that_is_there(asked: Measurement) -> None:
    program, *words = shlex.split(asked.command)
    if program == "afkb":
        return
    assert (program, words[0]) == ("python", "-m")
    module = ROOT / words[1].replace(".", "/")
    if not module.is_dir():
        assert module.with_suffix(".py").is_file()
        return
    parts = import_module(f"{words[1]}.parts" if "--only" in words else f"{words[1]}.__main__")
    asked_for = [word for word in words[2:] if not word.startswith("-")]
    assert not asked_for or asked_for[0] in parts.PARTS


@pytest.mark.parametrize("package", ["exports", "inference", "mapping", "serving", "sources"])
def test_every_part_is_measured(package: str) -> None:
    parts = set(import_module(f"bench.{package}.__main__").PARTS)
    # The paper has a command of its own; the hall is for a picture.
    told_elsewhere = {"paper", "deceived_hall"}
    assert parts - told_elsewhere <= {m.command.split()[-1] for m in MEASUREMENTS.values()}


def test_a_command_is_run_as_it_stands_and_kept(tmp_path: Path) -> None:
    asked = Measurement("x", "python -c 'print(\"7 of 9\")'", repeats=2)
    result = measured(asked)
    assert result.runs == (("7 of 9",), ("7 of 9",))
    assert result.memory_mb > 1
    result.save("x", tmp_path)
    assert Result.load("x", tmp_path) == result
    assert Result.load("y", tmp_path) is None


def test_a_command_that_fails_is_not_measured() -> None:
    with pytest.raises(NotMeasured, match="no more"):
        measured(Measurement("x", "python -c 'raise SystemExit(\"no more\")'"))


def test_spread_is_told_in_hundredths_of_the_median() -> None:
    runs = [["a 10.0 ms, 3 of 4"], ["a 12.0 ms, 3 of 4"], ["a 11.0 ms, 3 of 4"]]
    assert "1 of 3 figures differ" in spread(runs)
    assert "one by 18 %" in spread(runs)
    assert "same figures" in spread([runs[0], runs[0]])
    assert "different lines" in spread([["1"], ["1 2"]])
    assert spread(runs[:1]) == ""


def test_what_was_not_measured_says_so(tmp_path: Path) -> None:
    assert "Not measured yet." in page(tmp_path)
    name = "afbits"  # No headline is read from it.
    made = Result(MEASUREMENTS[name].command, (("figure 42",),), 3.0, 5.0, "abc", "2026-01-01", "m")
    replace(made, seconds=4.0).save(name, tmp_path)
    assert "figure 42" in page(tmp_path)
