"""Every hook is documented, tested, and handed the knowledge base."""

from __future__ import annotations

import inspect
import re
from pathlib import Path

import pytest

from afkb.plugins import hookspecs

ROOT = Path(__file__).parents[2]
HOOKS = sorted(name for name in vars(hookspecs) if name.startswith("afkb_"))
GUIDE = (ROOT / "docs" / "writing-a-plugin.md").read_text(encoding="utf-8")
TESTS = "\n".join(p.read_text(encoding="utf-8") for p in sorted((ROOT / "tests").rglob("*.py")))


@pytest.mark.parametrize("hook", HOOKS)
def test_the_hook_has_a_docstring_that_says_what_to_return(hook: str) -> None:
    assert re.match(r"(Return|Open|Add) .+\.$", inspect.getdoc(getattr(hookspecs, hook)) or "")


@pytest.mark.parametrize("hook", HOOKS)
def test_the_hook_is_handed_the_knowledge_base(hook: str) -> None:
    assert "knowledge_base" in inspect.signature(getattr(hookspecs, hook)).parameters


@pytest.mark.parametrize("hook", HOOKS)
def test_a_test_uses_the_hook(hook: str) -> None:
    assert re.search(rf"\b(def |hook\.){hook}\b|\.{hook}\(", TESTS), f"no test implements {hook}"


@pytest.mark.parametrize("hook", HOOKS)
def test_the_guide_shows_its_signature(hook: str) -> None:
    parameters = ", ".join(inspect.signature(getattr(hookspecs, hook)).parameters)
    assert f"{hook}({parameters})" in GUIDE
