"""With which ontology a map was made: recorded by the run, found again by what explains the map."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Sequence
from pathlib import Path

from pyoxigraph import NamedNode

from afkb.errors import MapError
from afkb.extensions import files_behind
from afkb.knowledge import AfNet, bundled_ontology
from afkb.store.stored import RUN_FILE, StoredMap


def ontology_record(files: Sequence[Path]) -> list[dict[str, str]]:
    """The ontology and its extensions in order, as run.json has them: `file` and `sha256`."""
    return [{"file": str(file.resolve()), "sha256": digest(file)} for file in files]


def digest(file: Path) -> str:
    """SHA-256 of an ontology file, or of an extension with the tables that it brings."""
    found = hashlib.sha256()
    for part in files_behind([bundled_ontology(), file])[1:]:
        for table in sorted(part.rglob("*.csv")) if part.is_dir() else [part]:
            found.update(table.read_bytes())
    return found.hexdigest()


def knowledge_of(stored: StoredMap, extensions: Sequence[Path] = ()) -> AfNet:
    """The knowledge base that a map was made with; `extensions` stand in for those recorded.

    `MapError` where an extension is no longer where it was.
    """
    recorded = _recorded(stored)
    if extensions or not recorded:
        return AfNet(None, list(extensions))
    first, *others = recorded
    gone = [file for file in others if not file.exists()]
    if gone:
        raise MapError(
            f"{stored.folder}: it was made with {gone[0]}, which is not there any more; "
            "name where that is now with --ontology"
        )
    is_bundled = first.name == bundled_ontology().name or not first.exists()
    return AfNet(None if is_bundled else first, others)


def changed_since(stored: StoredMap, kb: AfNet) -> list[str]:
    """Names of the ontology files that differ from those that the map was made with."""
    made_with = stored.names(NamedNode(stored.base + "run"), "prov:used")
    nodes = [NamedNode(stored.base + name) for name in made_with]
    digests = {stored.name(node, "afn:sha256") for node in nodes}
    return [file.name for file in kb.files if digests and digest(file) not in digests]


def _recorded(stored: StoredMap) -> list[Path]:
    """The files that run.json names; none where it says nothing of them."""
    try:
        run = json.loads((stored.folder / RUN_FILE).read_text(encoding="utf-8"))
        return [Path(entry["file"]) for entry in run.get("ontology", [])]
    except (OSError, ValueError, AttributeError, KeyError, TypeError):
        return []
