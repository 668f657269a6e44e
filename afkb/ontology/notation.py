"""The notation of afbits: one line that says a whole statement, for people and files alike.

    Mug > ContainAbility = 0.95
    Mug/HandlePart > MediumWrapGrasp @ UprightPose, Small = 0.8

A category, perhaps a part of it, `>` the affordance, perhaps `@` the typical pose and the scale,
and `=` the strength.
"""

from __future__ import annotations

import re
from collections.abc import Mapping

from afkb.errors import KnowledgeError

_NAME = r"[A-Za-z][A-Za-z0-9_]*"
_AFBIT = re.compile(
    rf"\s*(?P<category>{_NAME})\s*(?:/\s*(?P<part>{_NAME})\s*)?>\s*(?P<feature>{_NAME})\s*"
    rf"(?:@\s*(?P<pose>{_NAME})\s*(?:,\s*(?P<scale>{_NAME})\s*)?)?"
    r"=\s*(?P<strength>[0-9.]+(?:e-?[0-9]+)?)\s*"
)


def write_afbit(cells: Mapping[str, str]) -> str:
    """The line that says an afbit; `cells` has category, feature, strength, perhaps more.

    >>> write_afbit({"category": "Mug", "feature": "ContainAbility", "strength": "0.95"})
    'Mug > ContainAbility = 0.95'
    """
    part = f"/{cells['part']}" if cells.get("part") else ""
    where = ", ".join(filter(None, (cells.get("pose"), cells.get("scale"))))
    at = f" @ {where}" if where else ""
    return f"{cells['category']}{part} > {cells['feature']}{at} = {float(cells['strength']):g}"


def read_afbit(text: str) -> dict[str, str]:
    """The cells of an afbit's line: category, part, feature, pose, scale, strength.

    `KnowledgeError` for a line that isn't in the notation, or a strength outside 0 to 1.

    >>> read_afbit("Mug/HandlePart > MediumWrapGrasp @ UprightPose, Small = 0.8")["scale"]
    'Small'
    """
    match = _AFBIT.fullmatch(text)
    if match is None:
        raise KnowledgeError(
            f"{text.strip()!r} is no afbit; write it as in `Mug > ContainAbility = 0.95` or "
            "`Mug/HandlePart > MediumWrapGrasp @ UprightPose, Small = 0.8`"
        )
    cells = {name: cell for name, cell in match.groupdict().items() if cell}
    try:
        strength = float(cells["strength"])
    except ValueError:
        strength = -1.0
    if not 0 <= strength <= 1:
        raise KnowledgeError(f"{text.strip()!r}: strength {cells['strength']} is not in 0..1")
    return cells
