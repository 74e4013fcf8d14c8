"""Compute a canonical form of XML documents, in which elements with the same meaning have the same number.

Order and spelling do not matter. Defaults, such as the identity pose, are left out; a named material has the content
that the robot declares for the name. Numbers that the formats define are compared as doubles, all other values as
text with normalized space.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import NamedTuple, TypeAlias

from linkforge_compile.core.fields import number_fields
from linkforge_compile.core.models.joint import JointDynamics, JointMimic, JointSafetyController
from linkforge_compile.core.part import Element
from linkforge_compile.importers.spec_draft import number_of
from linkforge_compile.source.xml_tree import XmlElement

Value: TypeAlias = tuple[float | str, ...]
"""The words of a text, with numbers converted."""

Rgba: TypeAlias = tuple[float | None, ...]
"""The numbers of a color; None for a word that is none."""

_NAMES = frozenset(("name", "link", "joint", "reference", "filename", "type"))
"""Attributes in which a number is a name."""

_WITH_NUMBERS = tuple(
    f"robot/{tag}/" for tag in ("link", "joint", "material", "group_state", "link_sphere_approximation")
)
"""Paths of elements whose numbers the format defines. What plugins read is text: 007 may be a serial number."""


def _implied(kind: type[Element]) -> Mapping[str, Value]:
    """Return what the absence of each number of a class means."""
    return {name: (spec.implied,) for name, spec in number_fields(kind).items() if spec.implied is not None}


_ZERO: Value = (0.0, 0.0, 0.0)
_POSE: Mapping[str, Value] = {"xyz": _ZERO, "rpy": _ZERO}
_MESH: Mapping[str, Value] = {"scale": (1.0, 1.0, 1.0)}
_DEFAULTS: Mapping[str, Mapping[str, Value]] = {
    "robot/link/visual/origin": _POSE,
    "robot/link/collision/origin": _POSE,
    "robot/link/inertial/origin": _POSE,
    "robot/joint/origin": _POSE,
    "robot/link/visual/geometry/mesh": _MESH,
    "robot/link/collision/geometry/mesh": _MESH,
    "robot/link/inertial/inertia": {"ixy": (0.0,), "ixz": (0.0,), "iyz": (0.0,)},
    "robot/joint/axis": {"xyz": (1.0, 0.0, 0.0)},
    **{f"robot/joint/{kind.TAG}": _implied(kind) for kind in (JointDynamics, JointMimic, JointSafetyController)},
}
"""What the absence of an attribute means, by the path of the element."""

_MAY_BE_MISSING = frozenset(path for path in _DEFAULTS if path.endswith(("/origin", "/axis")))
_QUATERNION = "quat_xyzw"
"""The rotation of a pose in URDF 1.1, in the place of `rpy`; urdfdom refuses a pose with both, even if one is 0."""
_AXIS = "robot/joint/axis"
_WITHOUT_AXIS = ("fixed", "floating")
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


def named_colors(robot: XmlElement) -> Iterator[tuple[XmlElement, str, Rgba]]:
    """Yield each material with a color, its name and the color, in the order of the document."""
    for child in robot.children:
        shapes = child.children if child.tag == "link" else ()
        for material in [child] if child.tag == "material" else [one for shape in shapes for one in shape.children]:
            color = color_of(material) if material.tag == "material" else None
            if color is not None:
                yield material, material.get("name") or "", color


def color_of(material: XmlElement) -> Rgba | None:
    """Return the color of a `<material>`, None for one without."""
    color = next((child for child in material.children if child.tag == "color"), None)
    return tuple(map(number_of, (color.get("rgba") or "").split())) if color else None


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
        values = element.values if source is element else {**source.values, **element.values}
        has_axis = path != _AXIS or parent.get("type") not in _WITHOUT_AXIS
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


def _is_default(child: CanonicalElement, path: str, parent: XmlElement) -> bool:
    """Whether a child means the same as its absence."""
    if path not in _MAY_BE_MISSING or child.attributes or child.children or child.text:
        return False
    return path != _AXIS or parent.get("type") not in _WITHOUT_AXIS


def visual_materials(robot: XmlElement) -> Iterator[XmlElement]:
    """Yield the materials in the visuals of a robot, in the order of the document."""
    for link in robot.children:
        for visual in link.children if link.tag == "link" else ():
            yield from (part for part in visual.children if visual.tag == "visual" and part.tag == "material")
