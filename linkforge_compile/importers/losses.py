"""Find what an import loses: compare a document with the one that its spec compiles to, in a canonical form.

In that form, elements with the same meaning have the same number: order and spelling do not matter, defaults such as
the identity pose are omitted, and a named material has the content that the robot declares for the name. Numbers
that the formats define are compared as doubles, all other values as text with normalized space.
"""

from __future__ import annotations

from collections import Counter, defaultdict, deque
from collections.abc import Hashable, Iterable, Iterator, Mapping
from typing import NamedTuple, TypeAlias

from linkforge_compile.core.fields import Number, Vector, field_specs
from linkforge_compile.core.models.geometry import Mesh, Transform
from linkforge_compile.core.models.joint import HAVE_NO_AXIS, JointDynamics, JointMimic, JointSafetyController
from linkforge_compile.core.models.link import KINDS, VISUAL, Collision, InertiaTensor, Visual, shown_colors
from linkforge_compile.core.part import Element
from linkforge_compile.diagnostics import Diagnostic
from linkforge_compile.diagnostics.codes.importing import (
    BECOMES_OTHER,
    COLORS_REORDERED,
    COMES_IN_ADDITION,
    DOES_NOT_COME_OUT,
    SHAPES_REORDERED,
    VERSION_FOR_CAPSULE,
)
from linkforge_compile.importers.link import Rgba, color_of, named_colors, visual_materials
from linkforge_compile.importers.spec_draft import is_same, number_of
from linkforge_compile.source import Span
from linkforge_compile.source.xml_tree import XmlDocument, XmlElement
from linkforge_compile.syntax import YamlFault, YamlMap, YamlNode, YamlScalar

_MAX_TEXT = 40
"""Characters shown of a value."""

_ShownShape: TypeAlias = "tuple[CanonicalElement, Rgba | None]"
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
    candidates: defaultdict[tuple[str | None, ...], deque[CanonicalElement]] = defaultdict(deque)
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


def _key(one: CanonicalElement) -> tuple[str | None, ...]:
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
    left = Counter((_without_text(shape), color) for shape, color in compiled)
    present = {form for form, _ in left}
    for shape, color in shapes:
        form = _without_text(shape)
        if left[form, color] > 0:
            left[form, color] -= 1
        elif form in present:
            return shape.element
    return None


def _without_text(one: CanonicalElement) -> Hashable:
    """Return what identifies a shape: its text, which no reader uses, may be omitted in the compiled document."""
    return one.tag, one.attributes, frozenset(Counter(map(_without_text, one.children)).items())


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


Value: TypeAlias = tuple[float | str, ...]
"""The words of a text, with numbers converted."""

_NAMES = frozenset(("name", "link", "joint", "reference", "filename", "type"))
"""Attributes in which a number is a name."""

_WITH_NUMBERS = tuple(
    f"robot/{tag}/" for tag in ("link", "joint", "material", "group_state", "link_sphere_approximation")
)
"""Paths of elements whose numbers the format defines. What plugins read is text: 007 may be a serial number."""


def _implied(kind: type[Element]) -> Mapping[str, Value]:
    """Return what the absence of each attribute of a class with numbers means."""
    specs = [spec for spec in field_specs(kind).values() if spec.xml and spec.implied is not None]
    numbers = {spec.xml: (spec.implied,) for spec in specs if isinstance(spec, Number)}
    vectors = {spec.xml: tuple(spec.implied) for spec in specs if isinstance(spec, Vector)}
    return {xml.removeprefix("@"): value for xml, value in {**numbers, **vectors}.items() if xml}


_DEFAULTS: Mapping[str, Mapping[str, Value]] = {
    **{
        f"robot/{path}/origin": _implied(Transform)
        for path in ("link/visual", "link/collision", "link/inertial", "joint")
    },
    **{f"robot/link/{kind.TAG}/geometry/mesh": _implied(Mesh) for kind in (Visual, Collision)},
    "robot/link/inertial/inertia": _implied(InertiaTensor),
    "robot/joint/axis": {"xyz": (1.0, 0.0, 0.0)},
    **{f"robot/joint/{kind.TAG}": _implied(kind) for kind in (JointDynamics, JointMimic, JointSafetyController)},
}
"""What the absence of an attribute means, by the path of the element."""

_MAY_BE_MISSING = frozenset(path for path in _DEFAULTS if path.endswith(("/origin", "/axis")))
_QUATERNION = "quat_xyzw"
"""The rotation of a pose in URDF 1.1, in the place of `rpy`; urdfdom refuses a pose with both, even if one is 0."""
_AXIS = "robot/joint/axis"
_VISUAL_MATERIAL = "robot/link/visual/material"


class CanonicalElement(NamedTuple):
    """An element in canonical form; elements with the same `number`, of documents read together, mean the same."""

    element: XmlElement
    number: int
    tag: str
    attributes: frozenset[tuple[str, Value]]
    text: Value
    children: tuple[CanonicalElement, ...]


def canonicalize(*robots: XmlElement) -> list[CanonicalElement]:
    """Return the canonical forms of the roots of documents that are to be compared."""
    cache = _Cache()
    return [_Canonicalizer(robot, cache).canonical(robot, "robot", robot) for robot in robots]


_Content: TypeAlias = tuple[str, frozenset[tuple[str, Value]], Value, tuple[int, ...]]
"""Tag, attributes, text and the sorted numbers of the children."""


class _Cache:
    """Results shared by the documents: a robot repeats the same attributes and values thousands of times."""

    def __init__(self) -> None:
        self.numbers: dict[_Content, int] = {}
        self.attributes: dict[tuple[str, bool, tuple[tuple[str, str], ...]], frozenset[tuple[str, Value]]] = {}
        self.values: dict[str, Value] = {}


class _Canonicalizer:
    def __init__(self, robot: XmlElement, cache: _Cache) -> None:
        self._cache = cache
        self._materials: dict[str, XmlElement] = {}
        declared = [child for child in robot.children if child.tag == "material"]
        for material in (*declared, *visual_materials(robot)):
            if (name := material.get("name")) and material.children:
                self._materials.setdefault(name, material)
        self._declared = set(self._materials.values())

    def canonical(self, element: XmlElement, path: str, parent: XmlElement) -> CanonicalElement:
        """Return the canonical form of an element at a path of tags."""
        source = element
        if path == _VISUAL_MATERIAL and not element.children:
            source = self._materials.get(element.get("name") or "", element)
        inside = [(f"{path}/{child.tag}", child) for child in self._children(source, path)]
        all_children = [(child_path, self.canonical(child, child_path, element)) for child_path, child in inside]
        children = tuple([child for child_path, child in all_children if not _is_default(child, child_path, element)])
        if path == "robot":
            children = tuple(_without_repeated_materials(children))
        values = element.values if source is element else {**source.values, **element.values}
        has_axis = path != _AXIS or parent.get("type") not in HAVE_NO_AXIS
        attributes = self._attributes(path, values, has_axis=has_axis)
        text = self._value(path, element.text) if element.text else ()
        content = element.tag, attributes, text, tuple(sorted([child.number for child in children]))
        numbers = self._cache.numbers
        number = numbers.setdefault(content, len(numbers))
        return CanonicalElement(element, number, element.tag, attributes, text, children)

    def _attributes(self, path: str, values: Mapping[str, str], *, has_axis: bool) -> frozenset[tuple[str, Value]]:
        key = path, has_axis, tuple(values.items())
        known = self._cache.attributes.get(key)
        if known is not None:
            return known
        defaults = _DEFAULTS.get(path, {}) if has_axis else {}
        if _QUATERNION in values:
            defaults = {name: value for name, value in defaults.items() if name != "rpy"}
        read = {name: (text,) if name in _NAMES else self._value(path, text) for name, text in values.items()}
        attributes = frozenset([(name, value) for name, value in read.items() if defaults.get(name) != value])
        self._cache.attributes[key] = attributes
        return attributes

    def _children(self, element: XmlElement, path: str) -> Iterable[XmlElement]:
        """Return the children of an element; those of the robot include the materials declared in visuals."""
        if path != "robot":
            return element.children
        others = (child for child in element.children if child not in self._declared)
        return (*self._materials.values(), *others)

    def _value(self, path: str, text: str) -> Value:
        words = text.split()
        if not words or not path.startswith(_WITH_NUMBERS):
            return tuple(words)
        value = self._cache.values.get(text)
        if value is None:
            numbers = ((number_of(word), word) for word in words)
            value = self._cache.values[text] = tuple(word if number is None else number for number, word in numbers)
        return value


def _without_repeated_materials(children: Iterable[CanonicalElement]) -> Iterator[CanonicalElement]:
    """Yield the children of a robot, of equal materials only the first."""
    seen: set[int] = set()
    for child in children:
        if child.tag != "material" or child.number not in seen:
            seen.add(child.number)
            yield child


def _is_default(child: CanonicalElement, path: str, parent: XmlElement) -> bool:
    """Whether a child means the same as its absence."""
    if path not in _MAY_BE_MISSING or child.attributes or child.children or child.text:
        return False
    return path != _AXIS or parent.get("type") not in HAVE_NO_AXIS
