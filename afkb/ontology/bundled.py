"""Where the ontology is that comes with the package."""

from __future__ import annotations

from pathlib import Path

from afkb.errors import KnowledgeError


def bundled_ontology() -> Path:
    """The ontology that comes with the package: in the wheel, else in the checkout.

    Its tables, counts, shapes and questions are in folders beside it.
    """
    package = Path(__file__).parent.parent
    for folder in (package / "_ontology", package.parent / "ontology"):
        if (folder / "afnet.owl").is_file():
            return folder / "afnet.owl"
    raise KnowledgeError(f"{package / '_ontology' / 'afnet.owl'}: missing; reinstall afkb")
