"""Finds what the documents tell people to type."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[2]
_FENCE = re.compile(r"^```(\w+)[^\n]*\n(.*?)^```", re.MULTILINE | re.DOTALL)
_LINK = re.compile(r"\]\(([^)#\s]+)(?:#[^)]*)?\)")


RUN_BY_THEIR_OWN_TESTS = (
    "examples/my_home/README.md",
    "examples/own_feature/README.md",
    "examples/third_party/README.md",
)
"""Documents whose commands run once, in the test that also looks at what came of them."""


@dataclass(frozen=True)
class Block:
    """A fenced block: its document, the line it starts on, its language and text."""

    document: str
    line: int
    language: str
    text: str

    @property
    def id(self) -> str:
        """File and line, as pytest shows it."""
        return f"{self.document}:{self.line}"


def documents() -> list[Path]:
    """Every Markdown document of the project, in a fixed order."""
    folders = [ROOT / "docs", ROOT / "examples"]
    return sorted(ROOT.glob("*.md")) + sorted(p for f in folders for p in f.rglob("*.md"))


def blocks(*languages: str) -> list[Block]:
    """Every fenced block of those languages, in reading order."""
    return [
        Block(path.relative_to(ROOT).as_posix(), text[: m.start()].count("\n") + 1, *m.groups())
        for path in documents()
        for text in [path.read_text(encoding="utf-8")]
        for m in _FENCE.finditer(text)
        if m.group(1) in languages
    ]


def links() -> list[tuple[Path, str]]:
    """Every link to a file of the project, with the document it stands in."""
    return [
        (path, target)
        for path in documents()
        for target in _LINK.findall(path.read_text(encoding="utf-8"))
        if "://" not in target and not target.startswith("mailto:")
    ]
