"""The materials of a robot that a module names: it declares them as well, because it sees no name of its user."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from linkforge_compile.migration.constants import constant_of
from linkforge_compile.migration.symbols import NotConstantError, Part, Parts, as_expression, is_literal
from linkforge_compile.migration.template import Choice, Content, Element, Use, walk
from linkforge_compile.migration.vectors import tokens_of
from linkforge_compile.migration.written import canonical


def materials_in(content: list[Content]) -> dict[str, Element]:
    """Return the materials with a color or a texture that does not depend on an argument, by name."""
    found: dict[str, Element] = {}
    for one in _elements(content):
        name = _name(one)
        if one.tag == "material" and name and any(isinstance(part, Element) for part in one.content):
            known = _known(one)
            if known is not None:
                found.setdefault(name, known)
    return found


def used_materials(content: list[Content], materials: Mapping[str, Element]) -> list[Content]:
    """Return the materials that a content names and does not declare."""
    elements = [one for one in walk(content) if isinstance(one, Element) and one.tag == "material"]
    declared = {_name(one) for one in elements if any(isinstance(part, Element) for part in one.content)}
    named = dict.fromkeys(name for one in elements if (name := _name(one)) and name not in declared)
    return [materials[name] for name in named if name in materials]


def _elements(content: list[Content]) -> Iterator[Element]:
    for one in walk(content):
        if isinstance(one, Element):
            yield one
        elif isinstance(one, Use) and one.inline is not None:
            yield from _elements(one.inline)


def _name(element: Element) -> str:
    name = canonical(element.attributes.get("name", ()))
    return str(name[0]) if len(name) == 1 and is_literal(name) else ""


def _known(element: Element) -> Element | None:
    """Return a material with its values in the place of their names; None if they are not known."""
    try:
        attributes = {name: _constants(parts) for name, parts in element.attributes.items()}
    except NotConstantError:
        return None
    content: list[Content] = []
    for one in element.content:
        if isinstance(one, Choice):
            return None
        if isinstance(one, Element):
            inner = _known(one)
            if inner is None:
                return None
            content.append(inner)
    return Element(element.tag, attributes, content)


def _constants(parts: Parts) -> Parts:
    if any(not isinstance(part, str) and "path" in getattr(getattr(part, "func", None), "id", "") for part in parts):
        return parts
    return (" ".join("".join(_constant(part) for part in token) for token in tokens_of(parts)),)


def _constant(part: Part) -> str:
    return part if isinstance(part, str) else str(constant_of(as_expression((part,))))
