"""A query's answer as bytes of the media type that the client likes; runs in a sealed process."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from pyoxigraph import QueryTriples, serialize

from afkb.errors import QueryError
from afkb.serving.errors import Refused
from afkb.serving.forms import GRAPHS, RESULTS, Question
from afkb.serving.negotiation import preferred
from afkb.serving.shelf import Shelf


@dataclass(slots=True)
class Bounded:
    """A file to write to that holds so many bytes and refuses more."""

    most: int
    parts: list[bytes] = field(default_factory=list)
    length: int = 0

    def write(self, data: bytes) -> int:
        """Keep them; `Refused` where that is too much."""
        self.length += len(data)
        if self.length > self.most:
            raise Refused(
                422,
                f"the answer is larger than {self.most / (1 << 20):g} MB; ask for less, or in "
                "parts with LIMIT and OFFSET",
            )
        self.parts.append(bytes(data))
        return len(data)

    def flush(self) -> None:
        """Nothing waits to be written."""


def answer(shelf: Shelf, question: Question, most_bytes: int) -> tuple[str, bytes]:
    """The media type and the bytes of an answer.

    `QueryError` for what can't be parsed or isn't allowed, `Refused` for a form that there is not
    and for an answer of more than `most_bytes`.
    """
    asked = (question.sparql, question.default_graphs, question.named_graphs)
    found = shelf.dataset.answer(*asked)
    out = Bounded(most_bytes)
    try:
        if isinstance(found, QueryTriples):
            media = _chosen(question.accept, tuple(GRAPHS))
            prefixes = dict(shelf.dataset.prefixes) if media == "text/turtle" else None
            serialize(found, out, GRAPHS[media], prefixes=prefixes)  # type: ignore[arg-type]
        else:
            media = _chosen(question.accept, tuple(RESULTS))
            found.serialize(out, RESULTS[media])  # type: ignore[arg-type]
    except (OSError, ValueError) as error:
        told = " ".join(str(error).split())[:300]
        raise QueryError(f"the query failed while it ran: {told}") from error
    return media, b"".join(out.parts)


def _chosen(accept: str, offered: Sequence[str]) -> str:
    media = preferred(accept, offered)
    if media is None:
        raise Refused(406, f"this answer comes as {', '.join(offered)}; ask for one of them")
    return media
