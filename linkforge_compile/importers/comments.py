"""Comments of an XML file, placed in the spec where what they stand above, behind or in has come to stand."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from itertools import accumulate
from textwrap import dedent

from linkforge_compile.importers.banners import without_banners
from linkforge_compile.importers.draft import Draft
from linkforge_compile.importers.xml import XmlComment, XmlDocument, XmlElement
from linkforge_compile.named_tuple import NamedTuple
from linkforge_compile.syntax import YamlList, YamlMap, YamlNode


class Comments(NamedTuple):
    """Comments as `write` takes them: above a key or an item, and at the end of a map."""

    above: dict[YamlNode, str]
    endings: dict[YamlNode, str]


def placed_comments(document: XmlDocument, draft: Draft, tree: YamlMap) -> Comments:
    """Return every comment of a document but banners, and those in elements that are kept raw, which have theirs."""
    placing = _Placing(draft, tree)
    above: YamlNode | None = next(iter(tree)).key
    for item in without_banners(document.content):
        if isinstance(item, XmlComment):
            placing.put(item, above)
        elif item is document.root:
            placing.comments_of(document.root, None)
            above = None
    return Comments(_joined(placing.above), _joined(placing.endings))


class _Placing:
    def __init__(self, draft: Draft, tree: YamlMap) -> None:
        self.above: defaultdict[YamlNode, list[str]] = defaultdict(list)
        self.endings: defaultdict[YamlNode, list[str]] = defaultdict(list)
        self._draft, self._tree = draft, tree
        # What was made and then said by a shorter form, or not at all, has no place.
        self._present = set(_nodes(tree))

    def comments_of(self, element: XmlElement, holder: YamlNode | None) -> None:
        """Place the comments in an element; `holder` is the nearest key or item that the text has for it."""
        keys = [self._key(item) if isinstance(item, XmlElement) else None for item in element.content]
        # Of each place the nearest key before it and behind it, in one pass each: a file may be all comments.
        before = accumulate(keys, _latest)
        behind = list(accumulate(reversed(keys), _latest))[::-1]
        for item, key, last, following in zip(element.content, keys, before, behind, strict=True):
            if isinstance(item, XmlComment):
                near = last if item.follows and last is not None else following
                self._comment(item, element, near, holder)
            elif isinstance(item, XmlElement) and item not in self._draft.raw:
                self.comments_of(item, holder if key is None else key)

    def put(self, comment: XmlComment, above: YamlNode | None, ending: YamlNode | None = None) -> None:
        """Put a comment above a node, or at an end; that of the file where neither is given."""
        comments, node = (self.endings, ending or self._tree) if above is None else (self.above, above)
        text = _text(comment.text)
        if text:
            comments[node].append(text)

    def _comment(
        self, comment: XmlComment, element: XmlElement, near: YamlNode | None, holder: YamlNode | None
    ) -> None:
        body = self._draft.bodies.get(element)
        if near is not None:
            self.put(comment, near)
        elif isinstance(body, YamlMap) and len(body) > 0 and body in self._present:
            self.put(comment, None, body)
        else:
            self.put(comment, holder)

    def _key(self, element: XmlElement) -> YamlNode | None:
        key = self._draft.keys.get(element)
        return key if key in self._present else None


def _latest(last: YamlNode | None, key: YamlNode | None) -> YamlNode | None:
    return last if key is None else key


def _joined(comments: dict[YamlNode, list[str]]) -> dict[YamlNode, str]:
    return {node: "\n".join(texts) for node, texts in comments.items()}


def _nodes(node: YamlNode) -> Iterator[YamlNode]:
    yield node
    if isinstance(node, YamlMap):
        for entry in node:
            yield entry.key
            yield from _nodes(entry.value)
    elif isinstance(node, YamlList):
        for item in node:
            yield from _nodes(item)


def _text(comment: str) -> str:
    """Return the lines of a comment without the space around them that belongs to the layout of its file."""
    first, *others = comment.replace("\r\n", "\n").replace("\r", "\n").expandtabs(2).split("\n")
    return "\n".join(line.rstrip() for line in (first.strip(), *dedent("\n".join(others)).split("\n"))).strip("\n")
