"""What of an imported document its spec does not say again: the document beside the one that the spec compiles to."""

from __future__ import annotations

from collections import Counter, defaultdict, deque
from collections.abc import Iterable, Iterator
from typing import TypeAlias

from linkforge_compile.diagnostics import Diagnostic
from linkforge_compile.diagnostics.codes.importing import (
    BECOMES_OTHER,
    COMES_IN_ADDITION,
    DOES_NOT_COME_OUT,
    VERSION_FOR_CAPSULE,
)
from linkforge_compile.importers.draft import same
from linkforge_compile.importers.orders import recolored
from linkforge_compile.importers.said import Said, said
from linkforge_compile.source import Span
from linkforge_compile.source.xml_tree import XmlDocument, XmlElement
from linkforge_compile.syntax import YamlFault, YamlMap, YamlNode, YamlScalar

_Key: TypeAlias = tuple[str | None, ...]


def losses(document: XmlDocument, again: XmlDocument) -> Iterator[Diagnostic]:
    """Yield what two documents do not both say, told at the place in the first."""
    one, other = said(document.root, again.root)
    yield from _differences(one, other)
    yield from recolored(one, other)


def unread(tree: YamlNode, again: YamlNode | None, name: str = "robot") -> Iterator[Diagnostic]:
    """Yield what the text of a spec does not say of the tree that it was written from."""
    if isinstance(tree, YamlFault) or same(tree, again):  # a fault is told, and has no text
        return
    if isinstance(tree, YamlMap) and isinstance(again, YamlMap):
        for entry in tree:
            yield from unread(entry.value, again.get(entry.name), entry.name)
    elif isinstance(tree, YamlScalar) and isinstance(again, YamlScalar):
        yield _other(f"'{name}'", tree.text, again.text, tree.span)
    else:
        yield DOES_NOT_COME_OUT.at(tree.span, what=f"'{name}'")


def _differences(one: Said, again: Said) -> Iterator[Diagnostic]:
    if one.number == again.number:
        return
    yield from _attributes(one, again)
    if one.text != again.text:
        yield _other(f"the text of <{one.tag}>", one.element.text, again.element.text, one.element.span)
    yield from _children(one, again)


def _attributes(one: Said, again: Said) -> Iterator[Diagnostic]:
    ours, theirs = dict(one.attributes), dict(again.attributes)
    for name in dict.fromkeys((*one.element.values, *again.element.values)):
        if ours.get(name) == theirs.get(name):
            continue
        what = f"'{name}' of <{one.tag}>"
        was, now = one.element.get(name), again.element.get(name)
        if was is None and (one.tag, name) == ("robot", "version"):
            yield VERSION_FOR_CAPSULE.at(_capsule(one).span)
        elif was is None:
            yield COMES_IN_ADDITION.at(one.element.span, what=what)
        elif now is None:
            yield DOES_NOT_COME_OUT.at(one.element.attributes[name].span, what=what)
        else:
            yield _other(what, was, now, one.element.attributes[name].span)


def _capsule(one: Said) -> XmlElement:
    """Return the first capsule in an element, for which alone a version is added; itself where there is none."""
    waiting = [one.element]
    while waiting:
        element = waiting.pop()
        if element.tag == "capsule":
            return element
        waiting += reversed(element.children)
    return one.element


def _other(what: str, was: str, now: str, where: Span) -> Diagnostic:
    return BECOMES_OTHER.at(where, what=what, was=_shown(was), now=_shown(now))


_MOST_SHOWN = 40


def _shown(text: str) -> str:
    words = " ".join(text.split())
    return words if len(words) <= _MOST_SHOWN else f"{words[:_MOST_SHOWN]}..."


def _children(one: Said, again: Said) -> Iterator[Diagnostic]:
    lost, added = _without(one.children, again.children), _without(again.children, one.children)
    partners: defaultdict[_Key, deque[Said]] = defaultdict(deque)
    for child in added:
        partners[_key(child)].append(child)
    for child in lost:
        if alike := partners[_key(child)]:
            yield from _differences(child, alike.popleft())
        else:
            yield DOES_NOT_COME_OUT.at(child.element.span, what=_called(child))
    for child in (child for alike in partners.values() for child in alike):
        yield COMES_IN_ADDITION.at(one.element.span, what=_called(child))


def _without(children: Iterable[Said], others: Iterable[Said]) -> list[Said]:
    """Return those of the children that have no equal among the others, each of which is the equal of one."""
    left = Counter(other.number for other in others)
    alone = []
    for child in children:
        if left[child.number] > 0:
            left[child.number] -= 1
        else:
            alone.append(child)
    return alone


def _key(one: Said) -> _Key:
    """Return the tag and the names, by which an element is found again among others that differ."""
    return one.tag, *(one.element.get(name) for name in ("name", "reference", "link1", "link2"))


def _called(one: Said) -> str:
    name = one.element.get("name") or one.element.get("reference")
    return f"<{one.tag}> '{name}'" if name else f"<{one.tag}>"
