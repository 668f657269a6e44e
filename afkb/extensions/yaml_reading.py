"""Reads YAML with the line of every key, and without the guesses that surprise people.

`on`, `no` and dates are words here, as in YAML 1.2's core; a key that is given twice is an error;
anchors and aliases are refused, because nobody needs them in an extension.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import yaml
from yaml.nodes import MappingNode, Node, ScalarNode, SequenceNode

from afkb.errors import KnowledgeError
from afkb.extensions.problems import Problems

Path_ = tuple[str | int, ...]
_PLAIN_TAGS = frozenset(
    f"tag:yaml.org,2002:{name}"
    for name in ("str", "int", "float", "bool", "null", "map", "seq", "timestamp", "value", "merge")
)
"""Tags that YAML gives by itself; any other was written."""
_CONTROL = re.compile(r"[\x00-\x08\x0b\x0c\x0e-\x1f\x7f\ufffe\uffff]")
"""What no RDF/XML may hold."""
_WHOLE = re.compile(r"[-+]?[0-9]+")
_NUMBER = re.compile(r"[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?")
_WORDS: dict[str, Any] = {"": None, "~": None, "null": None, "true": True, "false": False}


@dataclass(slots=True)
class Document:
    """What a YAML file says, and the line of every key and list item, by its path."""

    file: Path
    data: dict[str, Any] = field(default_factory=dict)
    lines: dict[Path_, int] = field(default_factory=dict)

    def line(self, path: Path_) -> int:
        """The line of a key, or of what holds it."""
        while path and path not in self.lines:
            path = path[:-1]
        return self.lines.get(path, 1)

    def place(self, *path: str | int) -> str:
        """File and line of a key, for messages."""
        return f"{self.file.name}, line {self.line(path)}"


def read_yaml(file: Path, problems: Problems) -> Document:
    """The file as plain data; duplicate keys go to `problems`, unreadable files raise."""
    root = _composed(file)
    if root is None:
        raise KnowledgeError(
            f"{file}: empty; write a starter with `afkb ontology new` and fill that in"
        )
    if not isinstance(root, MappingNode):
        raise KnowledgeError(
            f"{file}, line 1: no extension: it holds no keys; start it with `extension: my-home`"
        )
    document = Document(file)
    reader = _Reader(document, problems)
    document.data = reader.mapping(root, ())
    return document


def _composed(file: Path) -> Node | None:
    try:
        text = file.read_text(encoding="utf-8-sig")
        return yaml.compose(text, Loader=yaml.SafeLoader)
    except UnicodeDecodeError as error:
        raise KnowledgeError(f"{file}: not UTF-8 (byte {error.start}); save it as UTF-8") from error
    except OSError as error:
        raise KnowledgeError(f"{file}: can't be read: {error.strerror}") from error
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        line = f", line {mark.line + 1}" if mark else ""
        raise KnowledgeError(f"{file}{line}: {_yaml_problem(error, text)}") from error
    except (yaml.YAMLError, RecursionError) as error:
        reason = " ".join(str(getattr(error, "reason", "nested too deep")).split())
        raise KnowledgeError(f"{file}: not YAML: {reason}; mend the file") from error


def _yaml_problem(error: yaml.MarkedYAMLError, text: str) -> str:
    if "'\\t'" in str(error.problem):
        return "a tab where YAML wants spaces; indent with spaces"
    problem = " ".join(str(error.problem).split())
    return f"not YAML: {problem}; mend that line or the one above"


class _Reader:
    """Turns nodes into plain data and notes where each stands."""

    def __init__(self, document: Document, problems: Problems) -> None:
        self._document = document
        self._problems = problems
        self._seen: set[int] = set()

    def mapping(self, node: MappingNode, path: Path_) -> dict[str, Any]:
        found: dict[str, Any] = {}
        for key_node, value_node in node.value:
            line = key_node.start_mark.line + 1
            if not isinstance(key_node, ScalarNode):
                self._add(line, "a key that is no word; write `name: …`")
                continue
            key = str(key_node.value)
            if key in found:
                first = self._document.lines[(*path, key)]
                self._add(
                    line,
                    f"{key} is given a second time, after line {first}; keep one, or rename this",
                )
                continue
            self._document.lines[(*path, key)] = line
            found[key] = self._value(value_node, (*path, key))
        return found

    def _value(self, node: Node, path: Path_) -> Any:
        if id(node) in self._seen:
            line = self._document.line(path)
            self._add(line, "an alias (`*name`) is not understood here; write it out")
            return None
        self._seen.add(id(node))
        if node.tag not in _PLAIN_TAGS:
            line = node.start_mark.line + 1
            self._add(line, f"a tag ({node.tag}) is not understood here; leave it out")
        if isinstance(node, MappingNode):
            return self.mapping(node, path)
        if isinstance(node, SequenceNode):
            for number, item in enumerate(node.value):
                self._document.lines[(*path, number)] = item.start_mark.line + 1
            return [self._value(item, (*path, n)) for n, item in enumerate(node.value)]
        assert isinstance(node, ScalarNode)
        if _CONTROL.search(node.value):
            self._add(node.start_mark.line + 1, "a control character in the text; take it out")
        return _scalar(node)

    def _add(self, line: int, problem: str) -> None:
        self._problems.add(f"{self._document.file.name}, line {line}", problem)


def _scalar(node: ScalarNode) -> Any:
    text = str(node.value)
    if node.style is not None:
        return text
    if text.lower() in _WORDS:
        return _WORDS[text.lower()]
    if _WHOLE.fullmatch(text):
        return int(text) if len(text) < 20 else float(text)
    return float(text) if _NUMBER.fullmatch(text) else text
