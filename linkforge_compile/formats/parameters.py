"""Free parts, which plugins read, as elements: an author's data decide their shape."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from linkforge_compile.core.exceptions import RobotGeneratorError
from linkforge_compile.formats.source_map import origin_of
from linkforge_compile.formats.xml_text import (
    KEEPS_SPACE,
    Xml,
    element_text,
    is_of_numpy,
    is_writable,
    is_xml_name,
    raw_text,
    spelled,
)
from linkforge_compile.source import SourceRef


def parameter_elements(parameters: Mapping[str, object], source: SourceRef | None = None, *path: str | int) -> Xml:
    """Return the parameters of a free part as child elements.

    A mapping is an element with children, where a key `_x` is its attribute `x` and `_text` its text; a list
    repeats its tag; anything else is text. They were written under `path` of what `source` points to.

    Raises:
        RobotGeneratorError: for a key that cannot be a tag.

    """
    return Xml(_elements(parameters, source, path))


def is_surely_writable(part: object) -> bool:
    """Whether a free part is texts and maps of texts that XML can hold; a no means that writing it will tell."""
    if isinstance(part, str):
        return is_writable(part)
    if not isinstance(part, dict):
        return False
    return all(key[:1] != "_" and is_xml_name(key) and is_surely_writable(inner) for key, inner in part.items())


def _elements(parameters: Mapping[str, object], source: SourceRef | None, path: tuple[str | int, ...]) -> str:
    elements: list[str] = []
    for tag, value in parameters.items():
        if not isinstance(value, str) and isinstance(value, Sequence):
            elements += [_element(tag, item, source, (*path, tag, number)) for number, item in enumerate(value)]
        else:
            elements.append(_element(tag, value, source, (*path, tag)))
    return "".join(elements)


def _element(tag: str, value: object, source: SourceRef | None, path: tuple[str | int, ...]) -> str:
    _require_name(tag)
    if isinstance(value, str) or not isinstance(value, Mapping):
        return element_text(tag, (), raw_text(_text(value)), origin_of(source, *path))
    attributes = [(key[1:], _text(item)) for key, item in value.items() if key.startswith("_") and key != "_text"]
    for name, _ in attributes:
        _require_name(name)
    children = _elements({key: item for key, item in value.items() if not key.startswith("_")}, source, path)
    text, origin = raw_text(_text(value.get("_text", ""))), origin_of(source, *path)
    return element_text(tag, attributes, text + children, origin + KEEPS_SPACE if text.isspace() else origin)


def _text(value: object) -> str:
    return spelled(value) if isinstance(value, float | int) or is_of_numpy(value) else str(value)


def _require_name(name: str) -> None:
    if not is_xml_name(name):
        raise RobotGeneratorError(f"'{name}' cannot be the name of an XML element or attribute")
