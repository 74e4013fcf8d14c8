"""Give the elements of an expanded xacro document the places where they were written."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping

from linkforge_compile.importers.xacro.process import MARK
from linkforge_compile.importers.xacro.run import Place, place_of
from linkforge_compile.source import Span
from linkforge_compile.source.xml_tree import Bounds, XmlAttribute, XmlComment, XmlContent, XmlDocument, XmlElement

_MARK = re.compile(rf'\s{MARK}(?:="[0-9:]*"|(?=-->))')
_FOLLOWS = f" {MARK}"

Find = Callable[[Place], XmlElement | None]
"""Returns the element at a place as written; None if its file cannot be read."""


def moved_back(document: XmlDocument, find: Find) -> XmlDocument:
    """Return a document without the marks of `process`, with the spans of the elements and attributes as written."""
    root = _moved(document.root, find, None)
    return XmlDocument(root, tuple(root if item is document.root else item for item in document.content))


class _Moved(XmlElement):
    """An element with the span of another; its attributes and raw text are given, not parsed."""

    _span: Span
    _attributes: Mapping[str, XmlAttribute]
    _raw: str

    @classmethod
    def to(cls, span: Span, attributes: Mapping[str, XmlAttribute], raw: str, expanded: XmlElement) -> _Moved:
        made = cls(*expanded)
        made._span, made._attributes, made._raw = span, attributes, raw
        return made

    @property
    def bounds(self) -> Bounds:
        return self._span, 0, 0

    @property
    def attributes(self) -> dict[str, XmlAttribute]:
        return dict(self._attributes)

    @property
    def raw(self) -> str:
        return self._raw


def _moved(element: XmlElement, find: Find, around: Span | None) -> XmlElement:
    mark = element.get(MARK)
    written = find(place_of(mark)) if mark else None
    span = written.span if written else around or element.span
    known = written.attributes if written else {}
    values = {name: value for name, value in element.values.items() if name != MARK}
    attributes = {
        name: XmlAttribute(name, value, known[name].bounds if name in known else (span, 0, 0))
        for name, value in values.items()
    }
    content = tuple(_content(item, find, span) for item in element.content)
    children = tuple(item for item in content if isinstance(item, XmlElement))
    expanded = element._replace(values=values, content=content, children=children)
    return _Moved.to(span, attributes, _MARK.sub("", element.raw), expanded)


def _content(item: XmlContent, find: Find, span: Span) -> XmlContent:
    if isinstance(item, XmlElement):
        return _moved(item, find, span)
    if isinstance(item, XmlComment):
        return XmlComment(item.text.removesuffix(_FOLLOWS), span, follows=item.text.endswith(_FOLLOWS))
    return item
