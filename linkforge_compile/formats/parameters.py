"""Free parts, which plugins read, as elements: an author's data decide their shape."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from linkforge_compile.core.exceptions import RobotGeneratorError
from linkforge_compile.formats.marks import mark
from linkforge_compile.formats.markup import Xml, is_of_numpy, is_writable, is_xml_name, spelled
from linkforge_compile.formats.node import Content, Node, lines_of
from linkforge_compile.source import SourceRef


def parameter_elements(parameters: Mapping[str, object], source: SourceRef | None = None, *path: str | int) -> Xml:
    """Return the parameters of a free part as child elements.

    A mapping is an element with children, where a key `_x` is its attribute `x` and `_text` its text; a list
    repeats its tag; anything else is text. They were written under `path` of what `source` points to.

    Raises:
        RobotGeneratorError: for a key that cannot be a tag.

    """
    return Xml("\n".join(lines_of(_nodes(parameters, source, path))))


def is_surely_writable(part: object) -> bool:
    """Whether a free part is texts and maps of texts that XML can hold; a no means that writing it will tell."""
    if isinstance(part, str):
        return is_writable(part)
    if not isinstance(part, dict):
        return False
    return all(key[:1] != "_" and is_xml_name(key) and is_surely_writable(inner) for key, inner in part.items())


def _nodes(parameters: Mapping[str, object], source: SourceRef | None, path: tuple[str | int, ...]) -> list[Content]:
    nodes: list[Content] = []
    for tag, value in parameters.items():
        if not isinstance(value, str) and isinstance(value, Sequence):
            nodes += [_node(tag, item, source, (*path, tag, number)) for number, item in enumerate(value)]
        else:
            nodes.append(_node(tag, value, source, (*path, tag)))
    return nodes


def _node(tag: str, value: object, source: SourceRef | None, path: tuple[str | int, ...]) -> Node:
    _require_name(tag)
    if isinstance(value, str) or not isinstance(value, Mapping):
        return Node(tag, (), [text] if (text := _text(value)) else [], mark(source, *path))
    attributes = [(key[1:], _text(item)) for key, item in value.items() if key.startswith("_") and key != "_text"]
    for name, _ in attributes:
        _require_name(name)
    children = _nodes({key: item for key, item in value.items() if not key.startswith("_")}, source, path)
    text = _text(value.get("_text", ""))
    return Node(tag, attributes, [text, *children] if text else children, mark(source, *path))


def _text(value: object) -> str:
    return spelled(value) if isinstance(value, float | int) or is_of_numpy(value) else str(value)


def _require_name(name: str) -> None:
    if not is_xml_name(name):
        raise RobotGeneratorError(f"'{name}' cannot be the name of an XML element or attribute")
