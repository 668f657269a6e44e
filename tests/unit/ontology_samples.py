"""Copies of the ontology with statements changed, and small extensions, as users would write."""

from __future__ import annotations

import re
from pathlib import Path

from afkb.knowledge import AFN, AfNet, bundled_ontology

_HEAD = """<?xml version="1.0" encoding="UTF-8"?>
<rdf:RDF xmlns:rdf="http://www.w3.org/1999/02/22-rdf-syntax-ns#"
  xmlns:rdfs="http://www.w3.org/2000/01/rdf-schema#" xmlns:owl="http://www.w3.org/2002/07/owl#"
  xmlns:skos="http://www.w3.org/2004/02/skos/core#" xmlns:afn="https://w3id.org/afkb/afnet#">
<owl:Ontology rdf:about="https://example.org/home"/>
"""


class Copy:
    """A copy of the bundled ontology to change statement by statement, as in a text editor."""

    def __init__(self) -> None:
        self.text = bundled_ontology().read_text(encoding="utf-8")

    def set(self, subject: str, prop: str, value: float) -> Copy:
        block = self._block(subject)
        changed, count = re.subn(rf"(<afn:{prop}[^>]*>)[^<]*", rf"\g<1>{value}", block)
        assert count == 1
        self.text = self.text.replace(block, changed)
        return self

    def delete(self, subject: str) -> Copy:
        self.text = self.text.replace(self._block(subject), "")
        return self

    def load(self, folder: Path) -> AfNet:
        path = folder / "changed.owl"
        path.write_text(self.text, encoding="utf-8")
        return AfNet(path)

    def _block(self, subject: str) -> str:
        start = self.text.index(f'  <rdf:Description rdf:about="{AFN}{subject}">')
        end = "\n  </rdf:Description>\n"
        return self.text[start : self.text.index(end, start) + len(end)]


def extension(folder: Path, body: str, name: str = "home.owl") -> Path:
    """An extension file with that body of RDF/XML, in the namespace https://example.org/home#."""
    path = folder / name
    path.write_text(_HEAD + body + "</rdf:RDF>\n", encoding="utf-8")
    return path
