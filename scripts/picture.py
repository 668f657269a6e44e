"""Takes the plan out of a map's report and writes it as a picture of its own.

usage: python scripts/picture.py MAP OUT.svg [CLASS …]

Named classes of the plan's groups (edges, labels, …) are left out.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path
from xml.etree import ElementTree

SVG = "http://www.w3.org/2000/svg"


def picture(report: str, left_out: set[str]) -> str:
    """The plan of a report.html as a standalone SVG with its styles, without tooltips."""
    found = re.search(r'<svg class="plan.*?</svg>', report, re.DOTALL)
    style = re.search(r"<style>(.*?)</style>", report, re.DOTALL)
    if not found or not style:
        raise SystemExit("error: no plan in that report; is it one that `afkb map` wrote?")
    plan = ElementTree.fromstring(found.group().replace("<svg ", f'<svg xmlns="{SVG}" ', 1))
    for parent in list(plan.iter()):
        for child in list(parent):
            if child.tag == f"{{{SVG}}}title" or left_out & set(child.get("class", "").split()):
                parent.remove(child)
    own_style = ElementTree.Element(f"{{{SVG}}}style")
    own_style.text = style.group(1)
    plan.insert(0, own_style)
    ElementTree.register_namespace("", SVG)
    return ElementTree.tostring(plan, encoding="unicode") + "\n"


if __name__ == "__main__":
    map_folder, out, *classes = sys.argv[1:]
    text = (Path(map_folder) / "report.html").read_text(encoding="utf-8")
    Path(out).write_text(picture(text, set(classes)), encoding="utf-8")
