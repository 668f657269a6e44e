"""Which object category a person means: by name, label, or what public tables call it."""

from __future__ import annotations

import re
from difflib import get_close_matches
from functools import lru_cache
from typing import TYPE_CHECKING

from afkb.errors import KnowledgeError
from afkb.figures.names import Names
from afkb.ontology.bundled import bundled_ontology

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from afkb.knowledge import AfNet

NEAR_ENOUGH = 0.6
"""Names that share less of their letters (difflib's ratio) aren't proposed."""


def category_named(text: str, kb: AfNet) -> str:
    """The object category, or group of them, that a text names.

    A name, a label, a plural, or a word of a public table ("cell phone"); case, spaces and hyphens
    make no difference. Raises `KnowledgeError`, with names that are near, where there is none.
    """
    found = find_category(text, kb)
    if found is None:
        near = near_names(text, _spelled(kb).values())
        hint = f"did you mean {', '.join(near)}?" if near else "see `afkb ontology show`"
        raise KnowledgeError(f"{text!r} is no object category of the ontology; {hint}")
    return found


def find_category(text: str, kb: AfNet) -> str | None:
    """The same, or None."""
    spelled, word = _spelled(kb), squeezed(text)
    tried = (word, word.removesuffix("s"), word.removesuffix("es"))
    return next((spelled[w] for w in tried if w in spelled), None)


def label_of(category: str, kb: AfNet) -> str:
    """What a category or a group is called in a sentence: `remote control`, `kitchenware`."""
    if category in kb.categories:
        return kb.categories[category].label
    return re.sub(r"(?<=[a-z0-9])(?=[A-Z])", " ", category).lower()


def near_names(text: str, names: Iterable[str], most: int = 4) -> list[str]:
    """Of some names those that are spelled alike."""
    plain = {squeezed(name): name for name in names}
    near = get_close_matches(squeezed(text), plain, n=most, cutoff=NEAR_ENOUGH)
    return [plain[name] for name in near]


def squeezed(name: str) -> str:
    """A name without case, spaces, hyphens and underscores.

    >>> squeezed("Cell-phone ") == squeezed("cell phone")
    True
    """
    return re.sub(r"[\s_#-]+", "", name).casefold()


@lru_cache(maxsize=8)
def _spelled(kb: AfNet) -> Mapping[str, str]:
    """Category by what it may be called, squeezed; own names before others' words."""
    spelled = {squeezed(k): k for name in kb.categories for k in kb.kinds_of(name)}
    for name, category in kb.categories.items():
        spelled.setdefault(squeezed(category.label), name)
    called = Names.load(bundled_ontology().parent / "tables").categories.written
    for word, name in called.items():
        if name in kb.categories:
            spelled.setdefault(squeezed(word), name)
    return spelled
