"""Renders the book as one HTML file that needs nothing beside it."""

from __future__ import annotations

import math
import re
from pathlib import Path

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup, escape

from afkb.knowledge import AfNet, Trapezoid
from afkb.knowledge.model import Range
from afkb.ontology.names import STATUSES
from afkb.reference.book import Book, grouped, read_book
from afkb.reference.overview import overview

_PARTS = Path(__file__).parent
_RULE = re.compile(r"rule (\w+) \([^)]*\)")
_OPTIONAL = re.compile(r"</(?:td|th|tr|tbody|thead|dt|dd|li)>")
"""End tags that HTML lets one leave out: a tenth of the page."""
_WIDTH, _HEIGHT, _MARGIN = 120, 26, 3


def reference_page(base: AfNet) -> str:
    """The page's HTML; the same ontology and extensions give the same text.

    Every affordance, object, room, relation and rule is an element whose id is the term's name.
    """
    book = read_book(base)
    environment = Environment(
        loader=FileSystemLoader(_PARTS),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters |= {
        "link": lambda name: _link(book, name),
        "label": lambda name: book.labels.get(name, name),
        "number": number,
        "span": span,
        "because": because,
        "words": _spaced,
    }
    environment.globals |= {
        "stated": lambda iri, prop: book.facts.many(iri, prop),
        "trapezoid": trapezoid,
        "by_strength": lambda afbits: grouped(afbits, lambda a: [number(a.strength)]),
        "read": lambda name: Markup((_PARTS / name).read_text(encoding="utf-8")),
    }
    template = environment.get_template("page.html")
    shown = {"book": book, "base": base, "overview": overview(book.facts), "statuses": STATUSES}
    return _OPTIONAL.sub("", template.render(shown))


def _link(book: Book, name: str) -> Markup:
    return Markup('<a href="#{}">{}</a>').format(name, book.labels.get(name, name))


def number(value: float) -> str:
    """A number as short as four digits allow.

    >>> number(0.70)
    '0.7'
    """
    return f"{value:.4g}"


def span(ends: Range | None, unit: str = "") -> str:
    """A range for people; an end that is open is told in words.

    >>> span((0.3, 0.58), "m")
    '0.3–0.58 m'
    >>> span((1.08, float("inf")), "m")
    'from 1.08 m'
    """
    if ends is None or ends == (-math.inf, math.inf):
        return ""
    low, high = (number(end) for end in ends)
    told = f"{low}–{high}"
    if math.isinf(ends[1]):
        told = f"from {low}"
    elif math.isinf(ends[0]):
        told = f"up to {high}"
    return f"{told} {unit}".strip()


def because(source: str, place: str) -> Markup:
    """A source in which rules are links; `place` is left out: the object's own row, told once."""
    parts = _RULE.split(source.replace(f" ({place})", ""))
    made = [escape(text) if n % 2 == 0 else _to_rule(text) for n, text in enumerate(parts)]
    return Markup("").join(made)


def _to_rule(name: str) -> Markup:
    return Markup('<a href="#{0}">{0}</a>').format(name)


def _spaced(name: str) -> str:
    return re.sub(r"(?<=[a-z])(?=[A-Z])", " ", name).lower().removeprefix("of ")


def trapezoid(shape: Trapezoid) -> Markup:
    """A small drawing of a fuzzy range: zero at both feet, one between the shoulders."""
    width = (shape.z2 - shape.z1) or 1.0
    places = ((x - shape.z1) / width for x in (shape.z1, shape.n1, shape.n2, shape.z2))
    xs = [f"{_MARGIN + (_WIDTH - 2 * _MARGIN) * place:.1f}" for place in places]
    low, high = _HEIGHT - _MARGIN, _MARGIN
    line = " ".join(f"{x},{y}" for x, y in zip(xs, (low, high, high, low), strict=True))
    return Markup(
        '<svg viewBox="0 0 {} {}" role="img" aria-label="fuzzy range"><polyline points="{}"/></svg>'
    ).format(_WIDTH, _HEIGHT, line)
