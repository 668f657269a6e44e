"""Takes a picture of a map's page as a browser shows it, with a node chosen.

usage: python scripts/page_picture.py MAP OUT.png NODE [light|dark]

Serves the map with `afkb serve` for the moment; needs Chromium (scripts/chromium.sh).
"""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from pathlib import Path

_QUIET = ("--no-sandbox", "--disable-gpu", "--disable-background-networking",
          "--disable-component-update", "--disable-sync")  # fmt: skip
_WITHIN_MS = 120_000


def take(url: str, out: Path, node: str, theme: str) -> None:
    """Open the page, choose the node, ask the query in the box, and write the picture."""
    from playwright.sync_api import sync_playwright

    chromium = shutil.which("chromium") or shutil.which("chromium-browser")
    if chromium is None:
        raise SystemExit("error: no Chromium; run scripts/chromium.sh")
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=chromium, args=_QUIET)
        page = browser.new_page(viewport={"width": 1600, "height": 1000}, color_scheme=theme)
        page.set_default_timeout(_WITHIN_MS)
        page.goto(f"{url}#{node}")
        page.wait_for_selector(".why table")
        page.locator(".asking [type=submit]").click()
        page.wait_for_selector(".answer tbody tr")
        page.evaluate("document.querySelector('.answered').textContent = ''")
        page.screenshot(path=out)
        browser.close()


def main(map_folder: str, out: str, node: str, theme: str = "light") -> None:
    """Serve the map for as long as the picture takes."""
    afkb = Path(sys.executable).parent / "afkb"
    command = [afkb, "serve", map_folder, "--port", "0", "--json"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as server:
        try:
            take(json.loads(server.stdout.readline())["url"], Path(out), node, theme)
        finally:
            server.terminate()


if __name__ == "__main__":
    main(*sys.argv[1:])
