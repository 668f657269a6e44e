"""The page of `afkb serve`, and report.html from disk, as a browser shows them."""

from __future__ import annotations

import io
import json
import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from afkb.plugins.host import PluginHost
from afkb.store import write_map
from afkb_nav2.exporter import Nav2Exporter
from afkb_report.exporter import ReportExporter
from store_samples import sample_map

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")
QUIET = ("--no-sandbox", "--disable-gpu", "--disable-background-networking",
         "--disable-component-update", "--disable-sync")  # fmt: skip
WAIT_MS = 20_000
READABLE = 4.5
"""Contrast of text with what is behind it, at least (WCAG 2.2, 1.4.3)."""
EVIL = '<img src=x onerror="window.evil=1">'
CONTRAST = """() => {
  const light = (c) => { const [r, g, b] = c.map((v) => v / 255)
    .map((v) => v <= 0.03928 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4);
    return 0.2126 * r + 0.7152 * g + 0.0722 * b; };
  const rgb = (text) => { const p = document.createElement("canvas").getContext("2d");
    p.fillStyle = text; p.fillRect(0, 0, 1, 1); return [...p.getImageData(0, 0, 1, 1).data]; };
  const behind = (e) => { for (; e; e = e.parentElement) { const c = rgb(getComputedStyle(e)
    .backgroundColor); if (c[3] === 255) return c.slice(0, 3); } return [255, 255, 255]; };
  return Math.min(...["h1", ".summary", ".hint", ".layers label", "a", "button.theme", "th", "h4",
    ".told", ".node-link", "dt", ".answered"].flatMap((s) => [...document.querySelectorAll(s)])
    .filter((e) => e.getClientRects().length).map((e) => {
      const [a, b] = [light(rgb(getComputedStyle(e).color).slice(0, 3)), light(behind(e))];
      return (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05); }));
}"""

pytestmark = pytest.mark.xdist_group("page")
"""One browser and one server serve all of them."""

if CHROMIUM is None:
    pytest.skip("no Chromium; see scripts/chromium.sh", allow_module_level=True)


@pytest.fixture(scope="module")
def home(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The small home's map; one of its notes is no friend of pages."""
    whole = replace(sample_map(), notes=(EVIL,))
    way = io.BytesIO()
    np.savetxt(way, whole.trajectory)
    return write_map(
        tmp_path_factory.mktemp("maps") / "home",
        whole,
        {"seconds": {"read": 1.25}},
        [Nav2Exporter(), ReportExporter()],
        PluginHost().knowledge_base,
        state={"trajectory.txt": way.getvalue()},
    )


@pytest.fixture(scope="module")
def browser():
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        started = playwright.chromium.launch(executable_path=CHROMIUM, args=QUIET)
        yield started
        started.close()


@pytest.fixture(scope="module")
def url(home: Path):
    command = [sys.executable, "-m", "afkb.cli.app", "serve", str(home), "--port", "0", "--json"]
    server = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    yield json.loads(server.stdout.readline())["url"]
    server.terminate()
    server.wait(timeout=20)


@pytest.fixture
def page(browser, request):
    """A page that must end without an error, and without a word to any other machine."""
    shown = browser.new_page(viewport={"width": 1280, "height": 900}, color_scheme="light")
    shown.set_default_timeout(WAIT_MS)
    shown.wrong, shown.asked = [], []
    shown.on("pageerror", lambda error: shown.wrong.append(str(error)))
    shown.on("console", lambda m: shown.wrong.append(m.text) if m.type == "error" else None)
    shown.on("request", lambda asked: shown.asked.append(asked.url))
    yield shown
    assert shown.evaluate("window.evil") is None
    shown.close()
    assert not shown.wrong


@pytest.fixture
def served(page, url):
    page.goto(url)
    page.wait_for_selector(".things .node")
    yield page
    assert all(asked.startswith((url, "data:")) for asked in page.asked)


def on_plan(page, id_: str):
    return page.locator(f".things:not(.lights) .node[data-id='{id_}'], .place[data-id='{id_}']")


def test_a_click_tells_beliefs_and_the_chain_behind_them(served) -> None:
    on_plan(served, "n2").click()
    panel = served.locator(".details")
    assert "Mug" in panel.locator(".bars").first.inner_text()
    served.wait_for_selector(".why table")
    assert "How that comes about" in panel.inner_text()
    panel.get_by_role("button", name="n1", exact=True).first.click()
    assert panel.locator("h3").first.inner_text() == "n1"
    assert served.locator(".links line").count() > 0
    assert served.url.endswith("#n1")


def test_the_keyboard_suffices(served) -> None:
    plan = served.locator(".plan")
    plan.focus()
    whole = plan.get_attribute("viewBox")
    served.keyboard.press("+")
    served.keyboard.press("ArrowRight")
    served.wait_for_function(
        "whole => document.querySelector('.plan').getAttribute('viewBox') !== whole", arg=whole
    )
    served.keyboard.press("0")
    served.wait_for_function(
        "whole => document.querySelector('.plan').getAttribute('viewBox') === whole", arg=whole
    )
    served.keyboard.press("Tab")
    standing = "document.activeElement.dataset.id"
    first = served.evaluate(standing)
    served.keyboard.press("ArrowRight")
    second = served.evaluate(standing)
    assert first and second and first != second
    served.keyboard.press("Enter")
    assert served.evaluate("document.activeElement.className") == "details"
    assert served.locator(".details h3").first.inner_text() == second
    assert second in served.locator(".spoken").inner_text()
    served.keyboard.press("Escape")
    assert served.locator(".details").is_hidden()
    assert served.evaluate(standing) == second


def test_rows_of_an_answer_and_nodes_light_each_other_up(served) -> None:
    served.locator("#sparql").fill(
        "SELECT ?n ?z { ?n a afn:ObservedEntity ; afn:z ?z } ORDER BY ?n"
    )
    served.locator("#sparql").press("Control+Enter")
    served.wait_for_selector(".answer tbody tr")
    assert served.locator(".answer tbody tr").count() == 3
    assert served.locator(".lights .node").count() == 3
    served.locator(".answer tbody tr").nth(1).hover()
    assert served.locator(".lights .node").count() == 1
    served.mouse.move(0, 0)
    on_plan(served, "n2").dispatch_event("click")
    assert served.locator(".answer tr.lit").inner_text().startswith("n2")
    served.locator("#sparql").fill("SELECT nonsense")
    served.get_by_role("button", name="Ask").click()
    served.wait_for_function(
        "() => document.querySelector('.answered').textContent.startsWith('error:')"
    )
    served.wrong.clear()  # Chromium reports the refusal's status, which is as it should be.


def test_the_library_is_at_hand(served) -> None:
    served.wait_for_function("() => document.querySelectorAll('#library option').length > 5")
    served.locator("#library").select_option("room-beliefs")
    assert "roomBelief" in served.locator("#sparql").input_value()
    served.get_by_role("button", name="Ask").click()
    served.wait_for_selector(".answer tbody tr")
    assert served.locator(".lights .room").count() == 2


def test_a_querys_parameters_are_fields_and_take_the_chosen_node(served) -> None:
    served.locator("#sparql").fill(
        "SELECT ?thing ?z { VALUES ?thing { scene:n1 }  # parameter, scene: the thing's id\n"
        "?thing afn:z ?z }"
    )
    field = served.locator(".parameters input")
    assert field.input_value() == "n1"
    on_plan(served, "n2").dispatch_event("click")
    assert "{ scene:n2 }" in served.locator("#sparql").input_value()
    served.get_by_role("button", name="Ask").click()
    served.wait_for_selector(".answer tbody tr")
    assert served.locator(".answer tbody tr").inner_text().startswith("n2")
    field.fill("n2 } DROP ALL")
    assert "{ scene:n2 }" in served.locator("#sparql").input_value()


def test_time_can_be_turned_back(served) -> None:
    slider = served.locator("#moment")
    slider.focus()
    assert on_plan(served, "n1").is_visible()
    assert served.locator(".past [data-id='n4']").is_hidden()
    slider.press("Home")
    assert on_plan(served, "n1").is_hidden()
    for _ in range(2):
        slider.press("ArrowRight")
    assert on_plan(served, "n1").is_visible()
    assert served.locator(".past [data-id='n4']").is_visible()
    assert served.locator(".robot").count() == 1
    slider.press("End")
    assert served.locator(".time output").inner_text() == "now"
    assert served.locator(".past [data-id='n4']").is_hidden()


def test_what_is_sought_is_found_and_layers_are_hidden(served) -> None:
    box = served.get_by_role("combobox", name="Find")
    box.fill("mug seen")
    assert served.locator("#found [role=option]").count() == 1
    box.press("ArrowDown")
    box.press("Enter")
    assert served.locator(".details h3").first.inner_text() == "n2"
    for layer, gone in (("predicted", "n3"), ("dynamic", "n2"), ("observed", "n1")):
        assert on_plan(served, gone).is_visible()
        served.get_by_label(layer, exact=True).uncheck()
        assert on_plan(served, gone).is_hidden()


def test_wheel_drag_and_two_fingers_move_the_plan(served) -> None:
    def view() -> list[float]:
        served.wait_for_timeout(250)
        return [float(v) for v in served.locator(".plan").get_attribute("viewBox").split()]

    box = served.locator(".canvas").bounding_box()
    x, y = box["x"] + box["width"] / 3, box["y"] + box["height"] / 3
    first = view()
    served.mouse.move(x, y)
    served.mouse.wheel(0, -300)
    nearer = view()
    assert nearer[2] < first[2]
    served.mouse.down()
    served.mouse.move(x + 60, y + 20, steps=3)
    served.mouse.up()
    moved = view()
    assert moved[0] < nearer[0] and moved[1] < nearer[1] and moved[2] == nearer[2]
    touch = served.context.new_cdp_session(served)
    for kind, apart in (("touchStart", 40), ("touchMove", 80), ("touchMove", 120), ("touchEnd", 0)):
        points = [{"x": x - apart, "y": y, "id": 1}, {"x": x + apart, "y": y, "id": 2}]
        touch.send(
            "Input.dispatchTouchEvent",
            {"type": kind, "touchPoints": points if apart else []},
        )
    assert view()[2] < moved[2]


@pytest.mark.parametrize("theme", ["light", "dark"])
def test_it_is_readable_in_light_and_dark_and_on_small_screens(served, theme) -> None:
    served.emulate_media(color_scheme=theme)
    on_plan(served, "n2").click()
    assert served.evaluate(CONTRAST) >= READABLE
    other = {"light": "dark", "dark": "light"}[theme]
    while served.locator(".theme").get_attribute("data-now") != other:
        served.locator(".theme").click()
    assert served.evaluate("getComputedStyle(document.documentElement).colorScheme") == other
    assert served.evaluate(CONTRAST) >= READABLE
    served.set_viewport_size({"width": 360, "height": 700})
    assert served.evaluate("document.documentElement.scrollWidth") <= 360


def test_a_report_opens_from_disk_and_tells_the_evidence(page, home: Path) -> None:
    page.goto((home / "report.html").as_uri())
    page.locator("[data-layer=grid]").wait_for()
    on_plan(page, "n2").click()
    assert "Mug" in page.locator(".details .bars").first.inner_text()
    page.locator("tr[data-id=n1]").hover()
    assert page.locator(".lights .node:not(.chosen)").count() == 1
    page.locator("tr[data-id=n1] a").click()
    assert page.locator(".details h3").first.inner_text() == "n1"
    assert page.locator("[data-seconds]").first.inner_text() == "see below"
    allowed = {(home / name).as_uri() for name in ("report.html", "run.json")}
    assert {
        asked.partition("#")[0] for asked in page.asked if not asked.startswith("data:")
    } <= allowed
