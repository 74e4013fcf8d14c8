"""What a document says, as values that are equal where two documents say the same, in whatever order and spelling.

Left out is what goes without saying, such as the pose of no motion; a material that is named has what the robot says
of that name. Numbers that the formats define are the same where they are the same double, all else where it is the
same text, but for the space around its words.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from typing import TypeAlias

from linkforge_compile.frozen import dataclass, field
from linkforge_compile.importers.draft import number_of
from linkforge_compile.importers.xml import XmlElement

Value: TypeAlias = tuple[float | str, ...]
"""The words of a text, numbers among them as what they are."""

_NAMES = frozenset(("name", "link", "joint", "reference", "filename", "type"))
"""Attributes in which a number is a name."""

_WITH_NUMBERS = tuple(
    f"robot/{tag}/" for tag in ("link", "joint", "material", "group_state", "link_sphere_approximation")
)
"""Where numbers are those of the format. What plugins read is text: 007 may be a serial number."""

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
    "robot/joint/dynamics": {"damping": (0.0,), "friction": (0.0,)},
    "robot/joint/mimic": {"multiplier": (1.0,), "offset": (0.0,)},
    "robot/joint/safety_controller": {"k_velocity": (0.0,)},
}
"""What an attribute says where it is not there, by where the element stands."""

_MAY_BE_MISSING = frozenset(path for path in _UNSAID if path.endswith(("/origin", "/axis")))
_QUATERNION = "quat_xyzw"
"""How URDF 1.1 turns a pose in the place of `rpy`; urdfdom refuses both at once, be one of them 0."""
_AXIS = "robot/joint/axis"
_HAVE_NO_AXIS = ("fixed", "floating")
_MATERIAL_OF_VISUAL = "robot/link/visual/material"


@dataclass(frozen=True, slots=True)
class Said:
    """An element; equal to any that says the same."""

    element: XmlElement = field(compare=False)
    tag: str
    attributes: frozenset[tuple[str, Value]]
    text: Value
    children: tuple[Said, ...] = field(compare=False)
    content: frozenset[tuple[Said, int]]
    """The children, each with how often it is there."""


def said(robot: XmlElement) -> Said:
    """Return what a document's element says."""
    return _Reader(robot).said(robot, "robot", robot)


class _Reader:
    def __init__(self, robot: XmlElement) -> None:
        self._values: dict[str, Value] = {}
        self._materials: dict[str, XmlElement] = {}
        declared = [child for child in robot.children if child.tag == "material"]
        for material in (*declared, *_materials_of_visuals(robot)):
            if (name := material.get("name")) and any(material.children):
                self._materials.setdefault(name, material)
        self._declared = set(self._materials.values())

    def said(self, element: XmlElement, path: str, owner: XmlElement) -> Said:
        """Return what an element says that stands in another."""
        known = element
        if path == _MATERIAL_OF_VISUAL and not any(element.children):
            known = self._materials.get(element.get("name") or "", element)
        inside = (self.said(child, f"{path}/{child.tag}", element) for child in self._children(known, path))
        children = tuple(child for child in inside if not _goes_without_saying(child, f"{path}/{child.tag}", element))
        stated_at = {**known.attributes, **element.attributes}
        unsaid = {} if path == _AXIS and owner.get("type") in _HAVE_NO_AXIS else _UNSAID.get(path, {})
        if _QUATERNION in stated_at:
            unsaid = {name: value for name, value in unsaid.items() if name != "rpy"}
        read = self._numbers if path.startswith(_WITH_NUMBERS) else _words
        attributes = {
            name: (attribute.value,) if name in _NAMES else read(attribute.value)
            for name, attribute in stated_at.items()
        }
        stated = frozenset((name, value) for name, value in attributes.items() if unsaid.get(name) != value)
        return Said(element, element.tag, stated, read(element.text), children, frozenset(Counter(children).items()))

    def _children(self, element: XmlElement, path: str) -> Iterable[XmlElement]:
        """Return what stands in an element; in the robot, every material that is said anywhere."""
        if path != "robot":
            return element.children
        others = (child for child in element.children if child not in self._declared)
        return (*self._materials.values(), *others)

    def _numbers(self, text: str) -> Value:
        value = self._values.get(text)
        if value is None:
            numbers = ((number_of(word), word) for word in text.split())
            value = self._values[text] = tuple(word if number is None else number for number, word in numbers)
        return value


def _words(text: str) -> Value:
    return tuple(text.split())


def _goes_without_saying(one: Said, path: str, owner: XmlElement) -> bool:
    if path not in _MAY_BE_MISSING or one.attributes or one.children or one.text:
        return False
    return path != _AXIS or owner.get("type") not in _HAVE_NO_AXIS


def _materials_of_visuals(robot: XmlElement) -> Iterable[XmlElement]:
    visuals = (part for link in robot.children if link.tag == "link" for part in link.children if part.tag == "visual")
    return (part for visual in visuals for part in visual.children if part.tag == "material")
