"""What all checks share: failing with a mend, and comparing results field by field."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np


def require(condition: bool, who: str, wrong: str, mend: str) -> None:
    """Raise `AssertionError` naming who breaks the contract, how, and what to do about it."""
    if not condition:
        raise AssertionError(f"{who}: {wrong}; {mend}")


def require_probability(value: float, who: str, what: str) -> None:
    """Raise unless the value is a finite number in 0..1."""
    require(
        isinstance(value, (int, float)) and math.isfinite(value) and 0 <= value <= 1,
        who,
        f"{what} is {value!r}",
        "a probability is a number in 0..1",
    )


def require_known(names: Sequence[str], known: Mapping[str, Any], who: str, what: str) -> None:
    """Raise unless every name is one that the ontology has."""
    unknown = [n for n in names if n not in known]
    require(
        not unknown,
        who,
        f"{what} {unknown} not in the ontology",
        "use IRI fragments such as SupportAbility, or bring an extension through afkb_ontologies",
    )


def require_name(plugin: object, who: str) -> str:
    """Raise unless the plugin has a name that a command line can take; return it."""
    name = getattr(plugin, "name", None)
    usable = isinstance(name, str) and bool(name) and not any(c.isspace() for c in name)
    require(usable, who, f"name is {name!r}", "give it a non-empty name without spaces")
    return str(name)


def same(a: Any, b: Any) -> bool:
    """Whether two results are equal to the last bit, arrays and NaN included."""
    if type(a) is not type(b):
        return False
    if isinstance(a, np.ndarray):
        return bool(a.dtype == b.dtype and a.shape == b.shape and a.tobytes() == b.tobytes())
    if is_dataclass(a) and not isinstance(a, type):
        return all(same(getattr(a, f.name), getattr(b, f.name)) for f in fields(a))
    if isinstance(a, Mapping):
        return list(a) == list(b) and all(same(a[k], b[k]) for k in a)
    if isinstance(a, (list, tuple)):
        return len(a) == len(b) and all(same(x, y) for x, y in zip(a, b, strict=True))
    if isinstance(a, float) and math.isnan(a):
        return bool(math.isnan(b))
    return bool(a == b)
