from __future__ import annotations

import base64
import dataclasses
import re
from html.parser import HTMLParser
from pathlib import Path

import cv2
import numpy as np

from afkb.drawing import inline_style
from afkb.drawing.png import grid_image
from afkb_report.exporter import ReportExporter, page
from store_samples import entity, sample_map

RUN = {"seconds": {"read": 1.25, "detect surfaces": 2.5}}


class Tags(HTMLParser):
    """Collects tags with attributes, and checks that they are closed in order."""

    void = frozenset(("meta", "input", "image", "link", "br"))

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.found: list[tuple[str, dict[str, str | None]]] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.found.append((tag, dict(attrs)))
        if tag not in self.void:
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        if tag not in self.void:
            assert self.open.pop() == tag


def parsed(html: str) -> Tags:
    tags = Tags()
    tags.feed(html)
    assert not tags.open
    return tags


def classes(html: str, tag: str) -> list[str]:
    return [a.get("class") or "" for name, a in parsed(html).found if name == tag]


def test_it_is_one_page_that_needs_no_network() -> None:
    html = page(sample_map(), RUN)
    for _, attributes in parsed(html).found:
        for key in ("src", "href"):
            target = attributes.get(key) or ""
            assert target.startswith(("data:", "#")) or target in ("", "run.json", "scene.ttl")
    assert "http" not in html.replace("http, not", "")


def test_predicted_things_are_drawn_differently() -> None:
    drawn = classes(page(sample_map(), RUN), "circle")
    assert "node support seen" in drawn
    assert "node container seen dynamic" in drawn
    assert "node support predicted co-occurrence" in drawn
    assert re.search(r"\.node\.predicted \{[^}]*stroke-dasharray", inline_style())


def test_it_tells_stages_but_is_the_same_whatever_they_took() -> None:
    slow = {"seconds": {"read": 99.0, "detect surfaces": 98.0}}
    html = page(sample_map(), RUN)
    assert html == page(sample_map(), slow)
    assert 'data-seconds="detect surfaces"' in html
    assert ("iframe", "run.json") in [(n, a.get("src")) for n, a in parsed(html).found]


def test_names_from_outside_are_escaped() -> None:
    whole = dataclasses.replace(
        sample_map(),
        entities=(entity('n<1>"', affordances={"<script>alert(1)</script>": 0.9}),),
        notes=("<b>note</b>",),
        closures=(),
    )
    html = page(whole, {"seconds": {"<i>": 1}})
    assert "<script>alert" not in html
    assert "<b>note" not in html
    assert "<i>" not in html.replace('<i class="mark', "")
    parsed(html)


def test_a_map_of_nothing_still_has_a_page() -> None:
    whole = sample_map()
    empty = dataclasses.replace(
        whole,
        places=(),
        entities=(),
        bounds=(),
        doorways=(),
        rooms=(),
        edges=(),
        closures=(),
        notes=(),
        counts={},
        trajectory=np.zeros((0, 17)),
        grid=dataclasses.replace(whole.grid, probability=np.full((2, 2), np.nan, np.float32)),
    )
    assert "none" in page(empty, {})


def test_the_grid_is_drawn_with_y_up_and_unknown_left_out() -> None:
    probability = np.array([[0.0, 1.0], [np.nan, 0.5]], dtype=np.float32)
    data = base64.b64decode(grid_image(probability).partition(",")[2])
    image = cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_UNCHANGED)
    assert image[:, :, 0].tolist()[1] == [255, 0]
    assert image[0, 1, 0] == 128
    assert image[:, :, -1].tolist() == [[0, 255], [255, 255]]


def test_the_exporter_writes_the_page(tmp_path: Path) -> None:
    written = ReportExporter().export(sample_map(), tmp_path, RUN)
    assert written == [tmp_path / "report.html"]
    assert written[0].read_text() == page(sample_map(), RUN)
