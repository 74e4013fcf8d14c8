"""Comments of an XML file, placed in the spec where what they stand above, behind or in has come to stand.

A comment at the end of a line is about what ends or begins there, one on lines of its own about what follows.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterator
from itertools import accumulate
from textwrap import dedent
from typing import NamedTuple

from linkforge_compile.importers.banners import without_banners
from linkforge_compile.importers.draft import Draft
from linkforge_compile.source.xml_tree import XmlComment, XmlDocument, XmlElement
from linkforge_compile.syntax import YamlList, YamlMap, YamlNode


class Comments(NamedTuple):
    """Comments as `write` takes them: above a key or an item, and at the end of a map."""

    above: dict[YamlNode, str]
    endings: dict[YamlNode, str]


def placed_comments(document: XmlDocument, draft: Draft, tree: YamlMap) -> Comments:
    """Return every comment of a document but banners, and those in elements that are kept raw, which have theirs."""
    if "<!--" not in document.root.file.counted:
        return Comments({}, {})
    placing = _Placing(document.root, draft, tree)
    above: YamlNode | None = next(iter(tree)).key
    for item in without_banners(document.content):
        if isinstance(item, XmlComment):
            placing.put(item, above)
        elif item is document.root:
            placing.comments_of(document.root, None)
            above = None
    return Comments(_joined(placing.above), _joined(placing.endings))


_HEADING = re.compile(
    r"(?:[A-Z]+ )?(?:GROUPS|LINKS|JOINTS?|CHAINS|SUBGROUPS|STATES|EFFECTOR|COLLISIONS|PROPERTY|APPROXIMATIONS?)\s*[:,-]"
)
"""How what MoveIt's assistant writes above the sections of an SRDF begins: `END EFFECTOR: Purpose: ...`."""


class _Placing:
    def __init__(self, root: XmlElement, draft: Draft, tree: YamlMap) -> None:
        self.above: defaultdict[YamlNode, list[str]] = defaultdict(list)
        self.endings: defaultdict[YamlNode, list[str]] = defaultdict(list)
        self._draft, self._tree = draft, tree
        # What was made and then said by a shorter form, or not at all, has no place.
        self._present = set(_nodes(tree))
        self._headings = set(_headings(root))
        self._sections = dict(_by_first(draft.bodies[root]))

    def comments_of(self, element: XmlElement, holder: YamlNode | None) -> YamlNode | None:
        """Place the comments in an element; `holder` is the nearest key or item that the text has for it.

        Return the first key or item that the text has for what is in it, None where it has none.
        """
        keys = [self._key(item) if isinstance(item, XmlElement) else None for item in element.content]
        # Of each place the nearest key behind it, in one pass: a file may be all comments.
        behind = list(accumulate(reversed(keys), _latest))[::-1]
        first: YamlNode | None = None
        on_line = holder
        for item, key, following in zip(element.content, keys, behind, strict=True):
            if isinstance(item, XmlComment):
                self._comment(item, element, self._subject(item, on_line, following), holder)
            elif isinstance(item, XmlElement):
                around = holder if key is None else key
                inside = None if item in self._draft.raw else self.comments_of(item, around)
                said = _latest(inside, key)
                first = _latest(said, first)
                on_line = _latest(holder, said)
        return first

    def _subject(self, comment: XmlComment, on_line: YamlNode | None, following: YamlNode | None) -> YamlNode | None:
        """Return what a comment is about, `on_line` where it stands at the end of a line; None for what has no key."""
        if comment.follows and on_line is not None:
            return on_line
        if following is not None and comment in self._headings:
            return self._sections.get(following, following)
        return following

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


def _headings(root: XmlElement) -> Iterator[XmlComment]:
    """Yield the comments that stand apart from the element below them: those of a section, where it is the first.

    They are above an empty line, or have several lines above another comment, or are known as headings.
    """
    is_apart = is_above_another = False
    for item in reversed(root.content):
        if isinstance(item, XmlElement):
            is_apart = is_above_another = False
        elif isinstance(item, str):
            is_apart = is_apart or item.count("\n") > 1
        else:
            is_known = _HEADING.match(item.text.lstrip()) is not None
            is_apart = is_apart or is_known or (is_above_another and "\n" in item.text)
            is_above_another = True
            if is_apart:
                yield item


def _by_first(sections: YamlNode) -> Iterator[tuple[YamlNode, YamlNode]]:
    """Yield the keys and items with which each section begins, at every depth, and its key."""
    for entry in sections if isinstance(sections, YamlMap) else ():
        node = entry.value
        while isinstance(node, YamlMap) and len(node) > 0:
            first = next(iter(node))
            yield first.key, entry.key
            node = first.value
        if isinstance(node, YamlList) and len(node) > 0:
            yield node.items[0], entry.key


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
