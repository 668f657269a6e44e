"""What is wrong in extensions: gathered, so that all of it is said at once, each with its mend."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from difflib import get_close_matches
from pathlib import Path

from afkb.errors import KnowledgeError

MANY = 12
"""So many names are listed where none is near the one that was written."""


@dataclass(slots=True)
class Problems:
    """The problems of one extension, in the order of its lines.

    `folder`: where the file stands, as the user named it; places count from there.
    """

    folder: Path
    found: list[tuple[str, int, str]] = field(default_factory=list)

    def add(self, place: str, problem: str) -> None:
        """Note what is wrong at `file, line N` (or a file), with its mend."""
        entry = (*_parted(place), " ".join(problem.split()))
        if entry not in self.found:
            self.found.append(entry)

    @contextmanager
    def noting(self) -> Iterator[None]:
        """Note an error about a row, which names its place first, and go on."""
        try:
            yield
        except KnowledgeError as error:
            place, _, problem = str(error).partition(": ")
            self.add(place, problem)

    def raise_any(self) -> None:
        """Raise one `KnowledgeError` with a line for each problem, if there are any."""
        if self.found:
            raise KnowledgeError("\n".join(self.lines()))

    def lines(self) -> list[str]:
        """Each problem with file and line."""
        prefix = "" if self.folder == Path() else f"{self.folder}/"
        return [
            f"{prefix}{file}{f', line {line}' if line else ''}: {problem}"
            for file, line, problem in sorted(self.found)
        ]


def nearest(name: str, known: Iterable[str]) -> str:
    """The mend for an unknown name: those that look like it, else some or where to find them.

    >>> nearest("ContainAbilty", ["ContainAbility", "SupportAbility"])
    'did you mean ContainAbility?'
    >>> nearest("Wod", ["Wood", "Metal"])
    'did you mean Wood?'
    >>> nearest("Wood", ["WoodMaterial", "MetalMaterial"])
    'did you mean WoodMaterial?'
    """
    by_lower = {n.lower(): n for n in sorted(known)}
    written = name.lower().replace(" ", "")
    close = [n for n in by_lower if len(written) > 2 and n.startswith(written)][:3]
    close = close or get_close_matches(written, by_lower, n=3, cutoff=0.6)
    if close:
        return f"did you mean {' or '.join(by_lower[c] for c in close)}?"
    if len(by_lower) <= MANY:
        return f"known: {', '.join(by_lower.values()) or 'none'}"
    return "mend the name, or define it; `afkb ontology show` lists those that there are"


def nearest_of(name: str, known: Iterable[str]) -> str:
    """As `nearest`, for keys and columns: where none is near, all of them are listed.

    >>> nearest_of("colour", ["shape", "scale"])
    'known: scale, shape'
    """
    names = sorted(known)
    mend = nearest(name, names)
    return mend if mend.startswith("did") else f"known: {', '.join(names)}"


def _parted(place: str) -> tuple[str, int]:
    file, _, line = place.rpartition(", line ")
    return (file, int(line)) if file and line.isdigit() else (place, 0)
