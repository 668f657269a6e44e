"""Lets the site show documents that lie beside `docs/`, and follow links to files of the project.

MkDocs sees one folder. README, CONTRIBUTING, the examples and the files that documents link to are
taken in under `project/`, and links are written as the site has them.
"""

from __future__ import annotations

import os
import re
from pathlib import Path
from typing import TYPE_CHECKING

from mkdocs.structure.files import File, Files

if TYPE_CHECKING:
    from mkdocs.config.defaults import MkDocsConfig
    from mkdocs.structure.pages import Page

ROOT = Path(__file__).resolve().parents[1]
DOCS = ROOT / "docs"
LINK = re.compile(r"(!?\[[^\]]*\])\(([^)\s]+)\)")
PICTURE = re.compile(r"!\[[^\]]*\]\(")


def documents() -> list[Path]:
    """The documents beside `docs/`."""
    return sorted(ROOT.glob("*.md")) + sorted((ROOT / "examples").rglob("*.md"))


def site_path(file: Path) -> str:
    """Where a file of the project stands in the site, from the site's root."""
    if file.is_relative_to(DOCS):
        return file.relative_to(DOCS).as_posix()
    inside = file.relative_to(ROOT)
    name = "overview.md" if inside.name == "README.md" else inside.name
    return (Path("project") / inside.parent / name).as_posix()


def linked(document: Path) -> list[Path]:
    """The files of the project that a document links to, itself relative to its own folder."""
    targets = (match[2] for match in LINK.finditer(document.read_text(encoding="utf-8")))
    paths = (_target(document, target) for target in targets)
    return [path for path in paths if path is not None and path.is_file()]


def _target(document: Path, target: str) -> Path | None:
    if "://" in target or target.startswith(("#", "mailto:")):
        return None
    return (document.parent / target.split("#")[0]).resolve()


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Take in the documents beside `docs/`, and what any document links to."""
    beside = documents()
    for document in [*beside, *sorted(DOCS.rglob("*.md"))]:
        beside += [path for path in linked(document) if not path.is_relative_to(DOCS)]
    for path in dict.fromkeys(beside):
        files.append(File.generated(config, site_path(path), abs_src_path=str(path)))
    return files


def on_page_markdown(markdown: str, page: Page, config: MkDocsConfig, files: Files) -> str:
    """Write a page's links as the site has them; a link to a folder becomes its plain name."""
    document = Path(page.file.abs_src_path or "")
    here = Path(site_path(document)).parent

    def rewritten(match: re.Match[str]) -> str:
        path = _target(document, match[2])
        if path is None:
            return match[0]
        if not path.is_file():
            return match[1].strip("[]")
        anchor = match[2].partition("#")[2]
        target = os.path.relpath(site_path(path), here) + (f"#{anchor}" if anchor else "")
        return f"{match[1]}({target})"

    return LINK.sub(rewritten, markdown)
