"""Takes the graphs out of a sheet that `afkb reproduce` drew, and writes them as one picture.

usage: python scripts/sheet_picture.py SHEET.html OUT.svg
"""

from __future__ import annotations

import re
import sys
from pathlib import Path

COLUMNS, WIDTH, GAP = 3, 360, 12
"""Panels in a row, and their width and distance, px."""


def picture(sheet: str) -> str:
    """The graphs of a sheet's steps in rows, as a standalone SVG with its styles."""
    panels = re.findall(
        r'<svg viewBox="([^"]+)"[^>]*"The graph so far">(.*?)</svg>', sheet, re.DOTALL
    )
    style = re.search(r"<style>(.*?)</style>", sheet, re.DOTALL)
    if not panels or not style:
        raise SystemExit("error: no graphs in that sheet; is it one that `afkb reproduce` drew?")
    _, _, across, along = map(float, panels[0][0].split())
    height = round(WIDTH * along / across)
    rows = -(-len(panels) // COLUMNS)
    drawn = [
        f'<svg x="{n % COLUMNS * (WIDTH + GAP)}" y="{n // COLUMNS * (height + GAP)}" '
        f'width="{WIDTH}" height="{height}" viewBox="{view}">{_without_titles(inside)}</svg>'
        for n, (view, inside) in enumerate(panels)
    ]
    size = f"{COLUMNS * (WIDTH + GAP) - GAP} {rows * (height + GAP) - GAP}"
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {size}">\n'
        f'<style>{_of_drawings(style.group(1))}</style>\n<rect width="100%" height="100%" '
        f'fill="#fff"/>\n{"".join(drawn)}\n</svg>\n'
    )


def _without_titles(inside: str) -> str:
    """Without tooltips, which a picture in a document has none of."""
    return re.sub(r"<title>.*?</title>", "", inside, flags=re.DOTALL)


def _of_drawings(style: str) -> str:
    """The rules for classes and for text: the rest lays out the page."""
    return "\n".join(line for line in style.splitlines() if re.match(r"\.|svg \*|text", line))


if __name__ == "__main__":
    sheet_file, out = sys.argv[1:]
    drawn_from = Path(sheet_file).read_text(encoding="utf-8")
    Path(out).write_text(picture(drawn_from), encoding="utf-8")
