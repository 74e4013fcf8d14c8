"""What documents say, with numbers that are equal where they say the same, in whatever order and spelling.

Left out is what goes without saying, such as the pose of no motion; a material that is named has what the robot says
of that name. Numbers that the formats define are the same where they are the same double, all else where it is the
same text, but for the space around its words.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import NamedTuple, TypeAlias

from linkforge_compile.core.fields import number_fields
from linkforge_compile.core.models.joint import JointDynamics, JointMimic, JointSafetyController
from linkforge_compile.core.part import Element
from linkforge_compile.importers.draft import number_of
from linkforge_compile.source.xml_tree import XmlElement

Value: TypeAlias = tuple[float | str, ...]
"""The words of a text, numbers among them as what they are."""

_NAMES = frozenset(("name", "link", "joint", "reference", "filename", "type"))
"""Attributes in which a number is a name."""

_WITH_NUMBERS = tuple(
    f"robot/{tag}/" for tag in ("link", "joint", "material", "group_state", "link_sphere_approximation")
)
"""Where numbers are those of the format. What plugins read is text: 007 may be a serial number."""


def _implied(kind: type[Element]) -> Mapping[str, Value]:
    """Return what the numbers of an element are where they are not there."""
    return {name: (spec.implied,) for name, spec in number_fields(kind).items() if spec.implied is not None}


_ZERO: Value = (0.0, 0.0, 0.0)
_POSE: Mapping[str, Value] = {"xyz": _ZERO, "rpy": _ZERO}
_MESH: Mapping[str, Value] = {"scale": (1.0, 1.0, 1.0)}
_UNSAID: Mapping[str, Mapping[str, Value]] = {
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
"""What an attribute says where it is not there, by where the element stands."""

_MAY_BE_MISSING = frozenset(path for path in _UNSAID if path.endswith(("/origin", "/axis")))
_QUATERNION = "quat_xyzw"
"""How URDF 1.1 turns a pose in the place of `rpy`; urdfdom refuses both at once, be one of them 0."""
_AXIS = "robot/joint/axis"
_HAVE_NO_AXIS = ("fixed", "floating")
_MATERIAL_OF_VISUAL = "robot/link/visual/material"


class Said(NamedTuple):
    """What an element says; `number` is that of all that say the same in the documents that were read with it."""

    element: XmlElement
    number: int
    tag: str
    attributes: frozenset[tuple[str, Value]]
    text: Value
    children: tuple[Said, ...]


def said(*robots: XmlElement) -> list[Said]:
    """Return what the elements of documents say that are to be compared."""
    words = _Words()
    return [_Reader(robot, words).said(robot, "robot", robot) for robot in robots]


_Content: TypeAlias = tuple[str, frozenset[tuple[str, Value]], Value, tuple[int, ...]]
"""A tag, attributes, text and the numbers of what stands in an element, in their order."""


class _Words:
    """What was read of documents, for a robot says the same again and again."""

    def __init__(self) -> None:
        self.numbers: dict[_Content, int] = {}
        self.attributes: dict[tuple[str, bool, tuple[tuple[str, str], ...]], frozenset[tuple[str, Value]]] = {}
        self.values: dict[str, Value] = {}


class _Reader:
    def __init__(self, robot: XmlElement, words: _Words) -> None:
        self._words = words
        self._materials: dict[str, XmlElement] = {}
        declared = [child for child in robot.children if child.tag == "material"]
        for material in (*declared, *_materials_of_visuals(robot)):
            if (name := material.get("name")) and material.children:
                self._materials.setdefault(name, material)
        self._declared = set(self._materials.values())

    def said(self, element: XmlElement, path: str, owner: XmlElement) -> Said:
        """Return what an element says that stands in another."""
        known = element
        if path == _MATERIAL_OF_VISUAL and not element.children:
            known = self._materials.get(element.get("name") or "", element)
        inside = [(f"{path}/{child.tag}", child) for child in self._children(known, path)]
        said = [(where, self.said(child, where, element)) for where, child in inside]
        children = tuple([child for where, child in said if not _goes_without_saying(child, where, element)])
        values = element.values if known is element else {**known.values, **element.values}
        has_axis = path != _AXIS or owner.get("type") not in _HAVE_NO_AXIS
        attributes = self._attributes(path, values, has_axis=has_axis)
        text = self._read(path, element.text) if element.text else ()
        content = element.tag, attributes, text, tuple(sorted([child.number for child in children]))
        numbers = self._words.numbers
        return Said(element, numbers.setdefault(content, len(numbers)), element.tag, attributes, text, children)

    def _attributes(self, path: str, values: Mapping[str, str], *, has_axis: bool) -> frozenset[tuple[str, Value]]:
        asked = path, has_axis, tuple(values.items())
        known = self._words.attributes.get(asked)
        if known is not None:
            return known
        unsaid = _UNSAID.get(path, {}) if has_axis else {}
        if _QUATERNION in values:
            unsaid = {name: value for name, value in unsaid.items() if name != "rpy"}
        read = {name: (text,) if name in _NAMES else self._read(path, text) for name, text in values.items()}
        stated = frozenset([(name, value) for name, value in read.items() if unsaid.get(name) != value])
        self._words.attributes[asked] = stated
        return stated

    def _children(self, element: XmlElement, path: str) -> Iterable[XmlElement]:
        """Return what stands in an element; in the robot, every material that is said anywhere."""
        if path != "robot":
            return element.children
        others = (child for child in element.children if child not in self._declared)
        return (*self._materials.values(), *others)

    def _read(self, path: str, text: str) -> Value:
        words = text.split()
        if not words or not path.startswith(_WITH_NUMBERS):
            return tuple(words)
        value = self._words.values.get(text)
        if value is None:
            numbers = ((number_of(word), word) for word in words)
            value = self._words.values[text] = tuple(word if number is None else number for number, word in numbers)
        return value


def _goes_without_saying(one: Said, path: str, owner: XmlElement) -> bool:
    if path not in _MAY_BE_MISSING or one.attributes or one.children or one.text:
        return False
    return path != _AXIS or owner.get("type") not in _HAVE_NO_AXIS


def _materials_of_visuals(robot: XmlElement) -> Iterable[XmlElement]:
    visuals = (part for link in robot.children if link.tag == "link" for part in link.children if part.tag == "visual")
    return (part for visual in visuals for part in visual.children if part.tag == "material")
