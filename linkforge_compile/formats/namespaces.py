"""Finds the prefixes of raw XML, as in `drake:joint`, that no `xmlns` around them declares."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from linkforge_compile.core.part import attribute_pairs
from linkforge_compile.diagnostics import Diagnostic
from linkforge_compile.diagnostics.codes.formats import UNDECLARED_PREFIX
from linkforge_compile.formats.element import Extended, place_of_attribute, raw_texts
from linkforge_compile.formats.node import Node
from linkforge_compile.formats.parts import Held
from linkforge_compile.source import Key, SourceRef

_OF_XML = frozenset({"xml", "xmlns"})
_DECLARATION = "xmlns:"


def undeclared_prefixes(root: Extended, parts: Iterable[Held]) -> Iterator[Diagnostic]:
    """Yield a warning for each prefix in a root element or its parts that is not declared around it."""
    known = _OF_XML | _declared_by(_names(root))
    yield from _in_extras(root, known, root.source)
    for part, where, around, _ in parts:
        if part.extra_attributes or part.extra_elements:
            names = (name for holder in (*around, part) for name in _names(holder))
            yield from _in_extras(part, known | _declared_by(names), where)


def _in_extras(part: Extended, known: frozenset[str], where: SourceRef | None) -> Iterator[Diagnostic]:
    for name in _names(part):
        yield from _told(_unknown([name], known), *place_of_attribute(name, where), Key(name))
    for text, source, path in raw_texts(part, where):
        # Only what holds a colon is read once more.
        yield from _told(_in_xml(text, known) if ":" in text else (), source, *path)


def _names(part: Extended) -> list[str]:
    return [name for name, _ in attribute_pairs(part.extra_attributes)]


def _in_xml(text: str, known: frozenset[str]) -> Iterator[str]:
    """Yield the prefixes of raw XML that nothing declares; nothing for XML that cannot be read, which is told."""
    from linkforge_compile.formats.raw import well_formed_nodes

    def unknown(node: Node, known: frozenset[str]) -> Iterator[str]:
        names = [name for name, _ in node.attributes]
        known |= _declared_by(names)
        yield from _unknown([node.tag, *names], known)
        for child in node.content:
            if isinstance(child, Node):
                yield from unknown(child, known)

    for node in well_formed_nodes(text):
        yield from unknown(node, known)


def _declared_by(names: Iterable[str]) -> frozenset[str]:
    return frozenset(name.removeprefix(_DECLARATION) for name in names if name.startswith(_DECLARATION))


def _unknown(names: Iterable[str], known: frozenset[str]) -> Iterator[str]:
    for name in names:
        prefix, colon, _ = name.partition(":")
        if colon and prefix not in known:
            yield prefix


def _told(prefixes: Iterable[str], where: SourceRef | None, *path: str | int) -> Iterator[Diagnostic]:
    for prefix in dict.fromkeys(prefixes):
        yield UNDECLARED_PREFIX.at(where, *path, prefix=prefix)
