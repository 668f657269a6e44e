"""Writes a graph as RDF/XML whose bytes depend on its statements alone."""

from __future__ import annotations

from functools import cache
from xml.sax.saxutils import escape, quoteattr

from rdflib import BNode, Graph, Literal, URIRef
from rdflib.namespace import split_uri
from rdflib.term import Node


def to_rdfxml(graph: Graph, prefixes: dict[str, str]) -> str:
    """The graph as RDF/XML, subjects and statements sorted; blank nodes are nested.

    `prefixes`: prefix to namespace, for every namespace of a predicate. Each blank node must be
    the object of exactly one statement, as OWL's anonymous restrictions are.
    """
    by_namespace = {namespace: prefix for prefix, namespace in prefixes.items()}
    lines = ['<?xml version="1.0" encoding="UTF-8"?>', "<rdf:RDF"]
    lines += [f"  xmlns:{p}={quoteattr(n)}" for p, n in sorted(prefixes.items())]
    lines[-1] += ">"
    subjects = sorted(s for s in set(graph.subjects()) if isinstance(s, URIRef))
    for subject in subjects:
        lines += _description(graph, subject, by_namespace, "  ")
    return "\n".join([*lines, "</rdf:RDF>", ""])


def _description(
    graph: Graph, subject: Node, by_namespace: dict[str, str], indent: str
) -> list[str]:
    about = f" rdf:about={quoteattr(str(subject))}" if isinstance(subject, URIRef) else ""
    lines = [f"{indent}<rdf:Description{about}>"]
    statements = (
        (str(p), _statement(graph, p, o, by_namespace, indent + "  "))
        for p, o in graph.predicate_objects(subject)
    )
    for _, statement in sorted(statements):
        lines += statement
    return [*lines, f"{indent}</rdf:Description>"]


def _statement(
    graph: Graph, predicate: Node, value: Node, by_namespace: dict[str, str], indent: str
) -> list[str]:
    namespace, local = _split(str(predicate))
    tag = f"{by_namespace[namespace]}:{local}"
    if isinstance(value, BNode):
        inner = _description(graph, value, by_namespace, indent + "  ")
        return [f"{indent}<{tag}>", *inner, f"{indent}</{tag}>"]
    if isinstance(value, Literal):
        return [f"{indent}<{tag}{_literal_attribute(value)}>{escape(str(value))}</{tag}>"]
    return [f"{indent}<{tag} rdf:resource={quoteattr(str(value))}/>"]


@cache
def _split(predicate: str) -> tuple[str, str]:
    namespace, local = split_uri(predicate)
    return str(namespace), str(local)


def _literal_attribute(value: Literal) -> str:
    if value.language:
        return f' xml:lang="{value.language}"'
    return f" rdf:datatype={quoteattr(str(value.datatype))}" if value.datatype else ""
