"""Runs HermiT, which comes with owlready2, on sets of statements.

HermiT is called without `sync_reasoner_hermit`, which classifies every class against the whole
set of individuals: hours for 4,500 afbits, because definitions name individuals. One question,
whether the statements are consistent, takes seconds.
"""

from __future__ import annotations

import re
import shutil
import subprocess
import tempfile
from collections.abc import Iterable
from pathlib import Path

from rdflib import Graph, URIRef
from rdflib.namespace import OWL, RDF, RDFS
from rdflib.term import Node

from afkb.errors import KnowledgeError

Triple = tuple[Node, Node, Node]
NO_JAVA = "no Java; install one, as in: sudo apt-get install default-jre-headless"
_MEMORY = "-Xmx2000M"
_NOTHING = re.compile(r"^\t<?([^<>\s]+)>?$", re.MULTILINE)


def java() -> str | None:
    """The Java on the PATH, or None."""
    return shutil.which("java")


def logical(graph: Graph) -> list[Triple]:
    """The statements that mean something to a reasoner, without annotations and imports."""
    annotations = {*graph.subjects(RDF.type, OWL.AnnotationProperty)}
    annotations |= {RDFS.label, RDFS.comment, RDFS.seeAlso, RDFS.isDefinedBy, OWL.imports}
    annotations |= {OWL.versionInfo, OWL.versionIRI, OWL.deprecated}
    return [t for t in graph if t[1] not in annotations and t[0] not in annotations]


def is_consistent(triples: Iterable[Triple]) -> bool:
    """Whether the statements can all hold; `KnowledgeError` where HermiT can't take them."""
    code, said = _hermit(["-k"], triples)
    if code == 0:
        return "not satisfiable" not in said
    if "InconsistentOntologyException" in said:
        return False
    raise KnowledgeError(f"HermiT can't take the ontology: {_reason(said)}")


def unsatisfiable_classes(triples: Iterable[Triple]) -> list[URIRef]:
    """Classes of consistent statements that can have no instance, sorted."""
    code, said = _hermit(["-U", "-N"], triples)
    if code:
        raise KnowledgeError(f"HermiT can't take the ontology: {_reason(said)}")
    return sorted(URIRef(name) for name in _NOTHING.findall(said) if name != str(OWL.Nothing))


def _hermit(options: list[str], triples: Iterable[Triple]) -> tuple[int, str]:
    """Exit code and output of HermiT, asked about statements in a temporary file."""
    found = java()
    if found is None:
        raise KnowledgeError(NO_JAVA)
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "statements.nt"
        with file.open("w", encoding="utf-8") as out:
            out.writelines(f"{' '.join(node.n3() for node in triple)} .\n" for triple in triples)
        command = [found, _MEMORY, "-cp", _classpath(), "org.semanticweb.HermiT.cli.CommandLine"]
        done = subprocess.run(
            [*command, *options, file.as_uri()], capture_output=True, text=True, check=False
        )
    return done.returncode, done.stdout + done.stderr


def _classpath() -> str:
    import owlready2

    folder = Path(owlready2.__file__).parent / "hermit"
    return f"{folder}:{folder / 'HermiT.jar'}"


def _reason(said: str) -> str:
    lines = [line for line in said.splitlines() if line.strip() and not line.startswith("\tat ")]
    return lines[0] if lines else "it said nothing"
