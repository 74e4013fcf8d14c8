"""Find what an import loses: compare a document with the one that its spec compiles to."""

from __future__ import annotations

from collections import Counter, defaultdict, deque
from collections.abc import Iterable, Iterator, Mapping
from typing import TypeAlias

from linkforge_compile.core.models.link import KINDS, VISUAL, shown_colors
from linkforge_compile.diagnostics import Diagnostic
from linkforge_compile.diagnostics.codes.importing import (
    BECOMES_OTHER,
    COLORS_REORDERED,
    COMES_IN_ADDITION,
    DOES_NOT_COME_OUT,
    SHAPES_REORDERED,
    VERSION_FOR_CAPSULE,
)
from linkforge_compile.importers.canonical import CanonicalElement, Rgba, canonicalize, color_of, named_colors
from linkforge_compile.importers.spec_draft import is_same
from linkforge_compile.source import Span
from linkforge_compile.source.xml_tree import XmlDocument, XmlElement
from linkforge_compile.syntax import YamlFault, YamlMap, YamlNode, YamlScalar

_MAX_TEXT = 40
"""Characters shown of a value."""

_Key: TypeAlias = tuple[str | None, ...]
_ShownShape: TypeAlias = tuple[CanonicalElement, Rgba | None]
"""A shape and the color in which MuJoCo shows it; None for its gray."""


def losses(document: XmlDocument, compiled: XmlDocument) -> Iterator[Diagnostic]:
    """Yield the differences between an imported document and the compiled one, at places in the imported one."""
    one, other = canonicalize(document.root, compiled.root)
    yield from _differences(one, other)
    yield from _recolored_shapes(one, other)


def text_losses(tree: YamlNode, reread: YamlNode | None, name: str = "robot") -> Iterator[Diagnostic]:
    """Yield where the text of a spec, read again, differs from the tree that it was written from."""
    if isinstance(tree, YamlFault) or is_same(tree, reread):  # a fault is reported already, and has no text
        return
    if isinstance(tree, YamlMap) and isinstance(reread, YamlMap):
        for entry in tree:
            yield from text_losses(entry.value, reread.get(entry.name), entry.name)
    elif isinstance(tree, YamlScalar) and isinstance(reread, YamlScalar):
        yield _changed(f"'{name}'", tree.text, reread.text, tree.span)
    else:
        yield DOES_NOT_COME_OUT.at(tree.span, what=f"'{name}'")


def _differences(one: CanonicalElement, other: CanonicalElement) -> Iterator[Diagnostic]:
    if one.number == other.number:
        return
    yield from _attribute_differences(one, other)
    if one.text != other.text:
        yield _changed(f"the text of <{one.tag}>", one.element.text, other.element.text, one.element.span)
    yield from _child_differences(one, other)


def _attribute_differences(one: CanonicalElement, other: CanonicalElement) -> Iterator[Diagnostic]:
    ours, theirs = dict(one.attributes), dict(other.attributes)
    for name in dict.fromkeys((*one.element.values, *other.element.values)):
        if ours.get(name) == theirs.get(name):
            continue
        what = f"'{name}' of <{one.tag}>"
        was, now = one.element.get(name), other.element.get(name)
        if was is None and (one.tag, name) == ("robot", "version"):
            yield VERSION_FOR_CAPSULE.at(_first_capsule(one.element).span)
        elif was is None:
            yield COMES_IN_ADDITION.at(one.element.span, what=what)
        elif now is None:
            yield DOES_NOT_COME_OUT.at(one.element.attributes[name].span, what=what)
        else:
            yield _changed(what, was, now, one.element.attributes[name].span)


def _first_capsule(robot: XmlElement) -> XmlElement:
    """Return the first capsule of a robot, the only reason to add a version; the robot where there is none."""
    stack = [robot]
    while stack:
        element = stack.pop()
        if element.tag == "capsule":
            return element
        stack += reversed(element.children)
    return robot


def _changed(what: str, was: str, now: str, where: Span) -> Diagnostic:
    return BECOMES_OTHER.at(where, what=what, was=_shorten(was), now=_shorten(now))


def _shorten(text: str) -> str:
    words = " ".join(text.split())
    return words if len(words) <= _MAX_TEXT else f"{words[:_MAX_TEXT]}..."


def _child_differences(one: CanonicalElement, other: CanonicalElement) -> Iterator[Diagnostic]:
    missing, added = _without(one.children, other.children), _without(other.children, one.children)
    candidates: defaultdict[_Key, deque[CanonicalElement]] = defaultdict(deque)
    for child in added:
        candidates[_key(child)].append(child)
    for child in missing:
        if matches := candidates[_key(child)]:
            yield from _differences(child, matches.popleft())
        else:
            yield DOES_NOT_COME_OUT.at(child.element.span, what=_describe(child))
    for child in (child for matches in candidates.values() for child in matches):
        yield COMES_IN_ADDITION.at(one.element.span, what=_describe(child))


def _without(children: Iterable[CanonicalElement], others: Iterable[CanonicalElement]) -> list[CanonicalElement]:
    """Return the children without an equal among the others, each of which is the equal of one."""
    left = Counter(other.number for other in others)
    unmatched = []
    for child in children:
        if left[child.number] > 0:
            left[child.number] -= 1
        else:
            unmatched.append(child)
    return unmatched


def _key(one: CanonicalElement) -> _Key:
    """Return the tag and names that identify an element among others."""
    return one.tag, *(one.element.get(name) for name in ("name", "reference", "link1", "link2"))


def _describe(one: CanonicalElement) -> str:
    name = one.element.get("name") or one.element.get("reference")
    return f"<{one.tag}> '{name}'" if name else f"<{one.tag}>"


# Two orders matter to MuJoCo, which shows a shape without color in that of the visual before it, and gives the first
# color of a name to all materials that only have the name.


def _recolored_shapes(robot: CanonicalElement, compiled: CanonicalElement) -> Iterator[Diagnostic]:
    """Yield the first shape of each link that MuJoCo shows in another color in the compiled document, and why.

    Raw XML is written after all else, which changes the order. Each material name is reported once.
    """
    compiled_links = {link.element.get("name"): link for link in compiled.children if link.tag == "link"}
    colors, compiled_colors = _first_colors(robot.element), _first_colors(compiled.element)
    reported: set[str] = set()
    for link in robot.children:
        other = compiled_links.get(link.element.get("name")) if link.tag == "link" else None
        if other is None:
            continue
        shape = _first_recolored(_shown_shapes(link, colors), _shown_shapes(other, compiled_colors))
        if shape is None:
            continue
        material = _material_of(shape)
        name = (material.get("name") or "") if material else ""
        if not material or name not in {*colors, *compiled_colors}:
            yield SHAPES_REORDERED.at(shape.span, link=link.element.get("name"))
        elif name not in reported:
            reported.add(name)
            yield COLORS_REORDERED.at(material.span, name=name)


def _first_recolored(shapes: Iterable[_ShownShape], compiled: Iterable[_ShownShape]) -> XmlElement | None:
    """Return the first shape that the compiled link has too, but only in another color."""
    left = Counter((shape.number, color) for shape, color in compiled)
    present = {number for number, _ in left}
    for shape, color in shapes:
        if left[shape.number, color] > 0:
            left[shape.number, color] -= 1
        elif shape.number in present:
            return shape.element
    return None


def _shown_shapes(link: CanonicalElement, colors: Mapping[str, Rgba]) -> Iterator[_ShownShape]:
    shapes = [child for child in link.children if child.tag in KINDS]
    return zip(shapes, shown_colors(_own_color(shape.element, colors) for shape in shapes), strict=True)


def _own_color(shape: XmlElement, colors: Mapping[str, Rgba]) -> Rgba | None:
    material = _material_of(shape)
    return (color_of(material) or colors.get(material.get("name") or "")) if material else None


def _material_of(shape: XmlElement) -> XmlElement | None:
    children = shape.children if shape.tag == VISUAL else ()
    return next((child for child in children if child.tag == "material"), None)


def _first_colors(robot: XmlElement) -> dict[str, Rgba]:
    return {name: color for _, name, color in reversed(list(named_colors(robot)))}
