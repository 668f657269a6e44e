"""Checks every individual and term against the SHACL shapes of `ontology/shapes/`.

pySHACL spends its time per individual and property: about 20 s for 4,500 afbits, under a second
for an extension, of which only its own terms are looked at.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from rdflib import Graph, URIRef
from rdflib.namespace import RDFS, SH
from rdflib.term import Node

from afkb.errors import KnowledgeError
from afkb.quality.checked import Checked, short
from afkb.quality.findings import Finding

_FOCUS_LIMIT = 2000
"""Up to so many terms are named to pySHACL, which looks them up in a list."""


def read_shapes(folder: Path) -> Graph:
    """All shapes of a folder; `KnowledgeError` where there are none."""
    files = sorted(folder.glob("*.ttl"))
    if not files:
        raise KnowledgeError(f"{folder}: no shapes; reinstall afkb")
    shapes = Graph()
    for file in files:
        shapes.parse(file, format="turtle")
    return shapes


def check_shapes(checked: Checked, shapes: Graph) -> list[Finding]:
    """What the shapes find about the checked terms, in order of place."""
    import pyshacl

    focus = [str(term) for term in checked.own]
    if not focus:
        return []
    _, report, _ = pyshacl.validate(
        checked.graph,
        shacl_graph=shapes,
        inplace=True,
        focus_nodes=focus if len(focus) <= _FOCUS_LIMIT else None,
    )
    if not isinstance(report, Graph):
        raise KnowledgeError(f"the shapes can't be applied: {report}")
    return sorted(set(_findings(checked, shapes, report)))


def _findings(checked: Checked, shapes: Graph, report: Graph) -> Iterator[Finding]:
    for result in report.objects(None, SH.result):
        term = report.value(result, SH.focusNode)
        severity = report.value(result, SH.resultSeverity)
        if term is None or term not in checked.own or (severity == SH.Info and not checked.bundled):
            continue
        advice = severity == SH.Warning and not checked.bundled
        what = _what(shapes, report, result)
        mend = str(report.value(result, SH.resultMessage) or "mend it")
        yield checked.finding(term, what, mend, advice)


def _what(shapes: Graph, report: Graph, result: Node) -> str:
    shape = report.value(result, SH.sourceShape)
    kind = str(report.value(result, SH.sourceConstraintComponent)).removeprefix(str(SH))
    path = report.value(result, SH.resultPath)
    if path is None:
        return str(shapes.value(shape, RDFS.label) or "does not fit its shape")
    value = report.value(result, SH.value)
    limit = {
        name: _limit(shapes, shape, name)
        for name in ("class", "datatype", "minInclusive", "minExclusive", "maxInclusive",
                     "maxCount", "lessThanOrEquals")
    }  # fmt: skip
    text = "" if value is None else short(value) if isinstance(value, URIRef) else str(value)
    said = {
        "MinCountConstraintComponent": "is missing",
        "MaxCountConstraintComponent": f"is stated more than {_times(limit['maxCount'])}",
        "ClassConstraintComponent": f"{text} is no {limit['class']}",
        "DatatypeConstraintComponent": f"{text!r} is no {limit['datatype']}",
        "MinInclusiveConstraintComponent": f"{text} is below {limit['minInclusive']}",
        "MinExclusiveConstraintComponent": f"{text} is not above {limit['minExclusive']}",
        "MaxInclusiveConstraintComponent": f"{text} is above {limit['maxInclusive']}",
        "LessThanOrEqualsConstraintComponent": f"{text} is above {limit['lessThanOrEquals']}",
        "InConstraintComponent": f"{text!r} is none of the known ones",
        "MinLengthConstraintComponent": "is empty",
        "UniqueLangConstraintComponent": f"is given twice in the language {text}",
    }
    return f"{short(path)} {said.get(kind, f'{text!r} does not fit')}"


def _limit(shapes: Graph, shape: Node | None, name: str) -> str:
    found = shapes.value(shape, SH[name])
    return short(found) if isinstance(found, URIRef) else str(found)


def _times(limit: str) -> str:
    return {"1": "once"}.get(limit, f"{limit} times")
