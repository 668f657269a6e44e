"""The compliance kit catches what breaks the contract and says how to mend it."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from afkb import testing
from afkb.flow import Detection, Hypothesis, Relation, View
from afkb.knowledge import AfNet


class Table:
    """A well-behaved detector of one thing, the pattern that each test breaks."""

    name, affordances, stage = "table", ("SupportAbility",), 0

    def detect(self, view: View, earlier: Sequence[Detection]) -> Sequence[Detection]:
        return [self.changed(replace(testing.sample_detections()[0], detector="table"), view)]

    def changed(self, detection: Detection, view: View) -> Detection:
        return detection


class Recording:
    """A well-behaved source of three views."""

    uri, gravity_aligned = "memory", True

    def __len__(self) -> int:
        return 3

    def view(self, index: int) -> View:
        return testing.sample_view(x=0.1 * index, index=index, placed=False)

    def views(self, start: int = 0, stop: int | None = None, stride: int = 1) -> Iterator[View]:
        return (self.view(i) for i in range(start, len(self) if stop is None else stop, stride))


class Below:
    """A well-behaved predictor."""

    name, order, anchor, axiom = "below", 1, 3, "https://example.org/axiom"

    def predict(self, detections: Sequence[Detection]) -> Sequence[Hypothesis]:
        if not detections:
            return []
        support = {"SupportAbility": 0.7}
        anchors = (self.anchor,)
        return [Hypothesis("below", 1, Relation.BELOW, anchors, support, "Large", 0.7, self.axiom)]


@pytest.fixture(scope="module")
def knowledge_base() -> AfNet:
    return AfNet()


def test_well_behaved_plugins_pass(knowledge_base: AfNet) -> None:
    testing.check_detector(Table(), testing.sample_views(), knowledge_base)
    testing.check_source(Recording())
    testing.check_predictor(Below(), testing.sample_detections(), knowledge_base)
    testing.check_map(testing.sample_map(), knowledge_base)


def test_a_detector_that_is_random_is_caught() -> None:
    class Random(Table):
        ticks = itertools.count()

        def changed(self, detection: Detection, view: View) -> Detection:
            return replace(detection, n_pixels=100 + next(self.ticks))

    with pytest.raises(AssertionError, match="second time; seed"):
        testing.check_detector(Random(), testing.sample_views())


def test_a_detector_that_writes_into_the_depth_image_is_caught() -> None:
    class Writes(Table):
        def changed(self, detection: Detection, view: View) -> Detection:
            if view.depth_m is not None:
                view.depth_m[0, 0] = 0
            return detection

    with pytest.raises(AssertionError, match="work on a copy"):
        testing.check_detector(Writes(), testing.sample_views())


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"affordances": {"RollAbility3D": 0.9}}, "undeclared"),
        ({"detector": "somebody"}, "signs as"),
        ({"n_pixels": 0}, "n_pixels"),
        ({"image_box": (0, 0, 4000, 3000)}, "leaves the image"),
        ({"covariance_xyz": -np.eye(3)}, "eigenvalue"),
        ({"footprint_xy": np.zeros((0, 2))}, "footprint_xy"),
        ({"range_m": 1800.0}, "range_m"),
        ({"segment_xy": np.zeros(4)}, "segment_xy"),
    ],
)
def test_a_detection_that_makes_no_sense_is_caught(change: dict[str, object], message: str) -> None:
    class Wrong(Table):
        def changed(self, detection: Detection, view: View) -> Detection:
            return replace(detection, **change)

    with pytest.raises(AssertionError, match=message):
        testing.check_detector(Wrong(), testing.sample_views())


def test_a_detector_of_a_feature_nobody_knows_is_caught(knowledge_base: AfNet) -> None:
    class Unheard(Table):
        affordances = ("SingAbility",)

    with pytest.raises(AssertionError, match=r"SingAbility.*afkb_ontologies"):
        testing.check_detector(Unheard(), [], knowledge_base)


def test_a_source_that_reads_everything_at_once_is_caught() -> None:
    class Eager(Recording):
        def views(self, start: int = 0, stop: int | None = None, stride: int = 1) -> list[View]:
            return list(super().views(start, stop, stride))

    with pytest.raises(AssertionError, match="generator"):
        testing.check_source(Eager())


def test_a_source_that_can_be_read_once_only_is_caught() -> None:
    class Once(Recording):
        def __init__(self) -> None:
            self.left = iter([self.view(0), self.view(1), self.view(2)])

        def views(self, start: int = 0, stop: int | None = None, stride: int = 1) -> Iterator[View]:
            return self.left

    with pytest.raises(AssertionError, match="second time"):
        testing.check_source(Once())


def test_a_source_in_millimetres_is_caught() -> None:
    class Millimetres(Recording):
        def view(self, index: int) -> View:
            view = super().view(index)
            return replace(view, depth_m=view.depth_m * np.float32(1000))

    with pytest.raises(AssertionError, match="convert it to metres"):
        testing.check_source(Millimetres())


def test_a_source_that_renumbers_when_striding_is_caught() -> None:
    class Renumbers(Recording):
        def views(self, start: int = 0, stop: int | None = None, stride: int = 1) -> Iterator[View]:
            chosen = list(super().views(start, stop, stride))
            return (replace(v, index=i) for i, v in enumerate(chosen))

    with pytest.raises(AssertionError, match="keep each frame's index"):
        testing.check_source(Renumbers())


@pytest.mark.parametrize(("name", "value"), [("anchor", 7), ("axiom", "because"), ("order", 2)])
def test_a_hypothesis_that_makes_no_sense_is_caught(
    name: str, value: object, knowledge_base: AfNet
) -> None:
    wrong = type("Wrong", (Below,), {name: value})()
    with pytest.raises(AssertionError, match=name):
        testing.check_predictor(wrong, testing.sample_detections(), knowledge_base)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"existence": 1.7}, "existence is 1.7"),
        ({"supported_by": "thing-99"}, "refers to"),
        ({"id": "thing-2"}, "occur twice"),
        ({"movability": "Sometimes"}, "Static or Dynamic"),
        ({"category_belief": {"Flumadiddle": 1.0}}, "Flumadiddle"),
        ({"size_xyz": (0.1, -0.1, 0.1)}, "no size negative"),
    ],
)
def test_a_map_that_breaks_its_laws_is_caught(
    change: dict[str, object], message: str, knowledge_base: AfNet
) -> None:
    good = testing.sample_map()
    bad = replace(good, entities=(replace(good.entities[0], **change), *good.entities[1:]))
    with pytest.raises(AssertionError, match=message):
        testing.check_map(bad, knowledge_base)


def test_rooms_that_do_not_sum_to_one_are_caught(knowledge_base: AfNet) -> None:
    good = testing.sample_map()
    room = replace(good.rooms[0], belief={"Kitchen": 0.9, "UnknownRoom": 0.4})
    with pytest.raises(AssertionError, match="sums to"):
        testing.check_map(replace(good, rooms=(room,)), knowledge_base)


def test_an_exporter_that_writes_the_time_is_caught(tmp_path: Path) -> None:
    class Dated:
        name, in_map_folder, ticks = "dated", False, itertools.count()

        def export(self, topological_map: object, folder: Path, run: object) -> list[Path]:
            file = folder / "map.txt"
            file.write_text(f"made at {next(self.ticks)}")
            return [file]

    with pytest.raises(AssertionError, match="leave out times"):
        testing.check_exporter(Dated(), tmp_path)


def test_an_exporter_that_hides_a_file_is_caught(tmp_path: Path) -> None:
    class Hides:
        name, in_map_folder = "hides", False

        def export(self, topological_map: object, folder: Path, run: object) -> list[Path]:
            (folder / "extra.txt").write_text("x")
            (folder / "map.txt").write_text("x")
            return [folder / "map.txt"]

    with pytest.raises(AssertionError, match="exactly what it wrote"):
        testing.check_exporter(Hides(), tmp_path)
