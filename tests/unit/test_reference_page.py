from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path

import pytest

from afkb.knowledge import AfNet
from afkb.reference import reference_page
from afkb.reference.overview import overview
from afkb.reference.page import because, span
from extension_samples import KIOSK, table, yaml_file

ROOT = Path(__file__).parents[2]
CHROMIUM = shutil.which("chromium") or shutil.which("google-chrome")
MAIN_KINDS = (
    *(f"{kind} affordances" for kind in ("structural", "material", "grasp")),
    *("objects", "rooms"),
    *(f"{kind} afbits" for kind in ("structural", "material", "grasp")),
    *("duals, each direction", "co-occurrences"),
    *(f"figures: object {what}" for what in ("in room", "with object", "on object")),
)
HOME = [f"my-flat,r{n},kitchen,kiosk:1|mug:2" for n in range(3)]
pytestmark = pytest.mark.xdist_group("reference")


class Page(HTMLParser):
    """The ids, targets of links, and what the page would fetch."""

    def __init__(self, html: str) -> None:
        super().__init__()
        self.ids: list[str] = []
        self.targets: set[str] = set()
        self.fetched: list[str] = []
        self.feed(html)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        for name, value in attrs:
            if name == "id":
                self.ids.append(value or "")
            elif name == "href" and tag == "a":
                self.targets.add(value or "")
            elif name in ("src", "href", "srcset", "data"):
                self.fetched.append(value or "")


@pytest.fixture(scope="module")
def net() -> AfNet:
    return AfNet.load()


@pytest.fixture(scope="module")
def html(net: AfNet) -> str:
    return reference_page(net)


@pytest.fixture(scope="module")
def page(html: str) -> Page:
    return Page(html)


def test_every_affordance_object_room_and_relation_is_on_it_once(net: AfNet, page: Page) -> None:
    wanted = [*net.features, *net.categories, *net.rooms, *net.evidence_classes, *net.scales]
    wanted += [item.name for item in (*net.duals, *net.co_occurrences)]
    assert not set(wanted) - set(page.ids)
    assert len(page.ids) == len(set(page.ids))


def test_every_afbit_is_on_it_in_the_notation(net: AfNet, html: str) -> None:
    shown = html.replace("&gt;", ">")
    assert not [afbit.notation for afbit in net.afbits if afbit.notation not in shown]


def test_links_within_the_page_lead_somewhere(page: Page) -> None:
    within = {target[1:] for target in page.targets if target.startswith("#")}
    assert not within - set(page.ids) - {"", "all"}


def test_it_fetches_nothing_and_is_quick_to_open(html: str, page: Page) -> None:
    assert not page.fetched
    assert not re.search(r"@import|url\(|fetch\(|XMLHttpRequest", html)
    assert len(html.encode()) < 3_500_000


def test_figures_are_shown_with_their_counts(net: AfNet, html: str) -> None:
    kitchen = html[html.index('<article id="Kitchen">') :]
    kitchen = kitchen[: kitchen.index("</article>")]
    fridge = re.search(r'<tr><td><a href="#Fridge">fridge</a>.*', kitchen)
    figure = net.figures.object_in_room("Fridge", "Kitchen")
    assert fridge is not None
    assert f"{figure.p:.3g}</s>" in fridge[0]
    assert f"{figure.successes:g} of {figure.trials:g}, {figure.buildings} homes" in fridge[0]


def test_terms_of_an_extension_are_on_it_and_the_same_ontology_gives_the_same_bytes(
    net: AfNet, tmp_path: Path
) -> None:
    table(tmp_path, "rooms.csv", "building,room,category,objects", *HOME)
    home = yaml_file(tmp_path, "homes: [rooms.csv]\n" + KIOSK)
    html = reference_page(net.extended([home]))
    kiosk = html[html.index('<article id="Kiosk">') :]
    assert "home.yaml" in kiosk[: kiosk.index("</article>")]
    assert "with home.yaml" in html
    assert '<a href="#Kitchen">kitchen</a>' in kiosk[: kiosk.index("</article>")]
    out = tmp_path / "page.html"
    command = [Path(sys.executable).parent / "afkb", "ontology", "reference", "--out", out]
    seeded = os.environ | {"PYTHONHASHSEED": "7"}
    subprocess.run([*command, "--ontology", home], check=True, env=seeded, cwd=tmp_path)
    assert out.read_text(encoding="utf-8") == html
    assert str(tmp_path) not in html and str(ROOT) not in html


@pytest.mark.skipif(CHROMIUM is None, reason="needs chromium or google-chrome")
@pytest.mark.parametrize(
    ("place", "shown", "hidden"),
    [
        ("#Mug", "Mug", "Cup"),
        ("#filter=drinks%20handle", "Mug", "Bed"),
        ("#rooms", "Kitchen", "Mug"),
    ],
)
def test_it_shows_what_is_asked_for(
    html: str, tmp_path: Path, place: str, shown: str, hidden: str
) -> None:
    file = tmp_path / "page.html"
    file.write_text(html, encoding="utf-8")
    flags = ["--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={tmp_path / 'user'}"]
    asked = [str(CHROMIUM), *flags, "--dump-dom", f"{file.as_uri()}{place}"]
    dom = subprocess.run(asked, check=True, capture_output=True, text=True, timeout=120).stdout
    assert f'<article id="{shown}">' in dom
    assert f'<article id="{hidden}" hidden="">' in dom


def test_names_from_extensions_are_escaped() -> None:
    assert because("<b> rule ThinBends (rules.csv, line 2)", "") == (
        '&lt;b&gt; <a href="#ThinBends">ThinBends</a>'
    )


def test_ranges_are_told_in_words_where_an_end_is_open() -> None:
    assert span((float("-inf"), 0.4), "m") == "up to 0.4 m"
    assert span((float("-inf"), float("inf")), "m") == ""


def test_the_figures_in_the_document_are_those_of_the_ontology(net: AfNet) -> None:
    from afkb.knowledge.facts import read_facts
    from afkb.ontology.names import STATUSES

    rows = dict(overview(read_facts(net.files)))
    lines = []
    for kind in MAIN_KINDS:
        row = rows[kind]
        statuses = [row.by_status.get(status, 0) for status in STATUSES]
        numbers = [row.number, *statuses, row.with_two_sources, row.reviewed]
        lines.append(f"| {kind} | {' | '.join(f'{n:,}' if n else '' for n in numbers)} |")
    text = (ROOT / "docs" / "ontology.md").read_text(encoding="utf-8")
    stale = [line for line in lines if line not in text]
    assert not stale, "docs/ontology.md: put these lines into its table:\n" + "\n".join(lines)
