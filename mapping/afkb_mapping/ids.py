"""Names for nodes."""

from itertools import count


class Ids:
    """Numbers nodes in order of discovery, so that the same input names them the same."""

    def __init__(self) -> None:
        self._count = count(1)

    def __call__(self, kind: str) -> str:
        """The next name for a node of this kind, such as `surface-7`."""
        return f"{kind}-{next(self._count)}"
