"""From the elements of an expanded document back to those that were written."""

from __future__ import annotations

import re
from collections.abc import Callable

from linkforge_compile.frozen import replace
from linkforge_compile.importers.xacro.process import MARK
from linkforge_compile.importers.xacro.run import Place, place_of
from linkforge_compile.importers.xml import XmlComment, XmlContent, XmlDocument, XmlElement
from linkforge_compile.source import Span

_MARK = re.compile(rf'\s{MARK}(?:="[0-9:]*"|(?=-->))')
_FOLLOWS = f" {MARK}"

Find = Callable[[Place], XmlElement | None]
"""Returns the element at a place as it was written; None where its file cannot be read."""


def moved_back(document: XmlDocument, find: Find) -> XmlDocument:
    """Return a document without its marks, whose elements and attributes have the spans of those written."""
    root = _moved(document.root, find, None)
    return XmlDocument(root, tuple(root if item is document.root else item for item in document.content))


def _moved(element: XmlElement, find: Find, around: Span | None) -> XmlElement:
    mark = element.attributes.get(MARK)
    written = find(place_of(mark.value)) if mark else None
    span = written.span if written else around or element.span
    attributes = {}
    for name, attribute in element.attributes.items():
        if name != MARK:
            said = written.attributes.get(name) if written else None
            attributes[name] = replace(attribute, span=said.span if said else span)
    content = tuple(_content(item, find, span) for item in element.content)
    return XmlElement(element.tag, attributes, content, span, _MARK.sub("", element.raw))


def _content(item: XmlContent, find: Find, span: Span) -> XmlContent:
    if isinstance(item, XmlElement):
        return _moved(item, find, span)
    if isinstance(item, XmlComment):
        return XmlComment(item.text.removesuffix(_FOLLOWS), span, follows=item.text.endswith(_FOLLOWS))
    return item
