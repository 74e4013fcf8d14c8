"""What the readers of URDF refuse.

urdfdom refuses the whole robot for what is wrong with a joint or a name that is there twice, and leaves out the rest
of a link behind what is wrong in it; MuJoCo refuses the robot for either. Only the first element of a tag is read, but
of visuals and collisions each.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import NamedTuple

from linkforge_compile.core.fields import number_fields
from linkforge_compile.core.models.joint import (
    HAVE_NO_AXIS,
    NEED_LIMITS,
    JointCalibration,
    JointDynamics,
    JointLimits,
    JointMimic,
    JointSafetyController,
)
from linkforge_compile.core.part import Element
from linkforge_compile.diagnostics import Diagnostic, Note
from linkforge_compile.diagnostics.codes.importing import (
    LACKS_PART,
    NAME_IS_TAKEN,
    NO_NUMBERS,
    NO_TYPE_OF_JOINT,
)
from linkforge_compile.importers.draft import number_of
from linkforge_compile.importers.urdf.joint import TYPES_OF_JOINTS
from linkforge_compile.source.xml_tree import XmlAttribute, XmlElement

_UNBOUNDED = re.compile(r"[+-]?(?:inf|infinity|nan)", re.IGNORECASE)
"""No finite numbers: older versions of urdfdom take them, and MuJoCo does; vendors write such limits."""


class Refused(NamedTuple):
    """A fault that readers refuse, and the elements in which it lies, the robot's child first."""

    told: Diagnostic
    path: tuple[XmlElement, ...]


class _Part(NamedTuple):
    """What readers take of an element: how many numbers an attribute has, and the attributes that must be there."""

    numbers: Mapping[str, int] = {}
    needed: tuple[str, ...] = ()


def _part_of(kind: type[Element], *needed: str) -> _Part:
    """Return what readers take of an element whose fields are numbers, and `needed` besides."""
    specs = number_fields(kind)
    required = [name for name, spec in specs.items() if spec.is_required_in_urdf]
    return _Part(dict.fromkeys(specs, 1), (*needed, *required))


_MOMENTS = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
_ORIGIN = _Part({"xyz": 3, "rpy": 3})
_INERTIAL = {
    "origin": _ORIGIN,
    "mass": _Part({"value": 1}, ("value",)),
    "inertia": _Part(dict.fromkeys(_MOMENTS, 1), _MOMENTS),
}
_SHAPES = {
    "box": _Part({"size": 3}, ("size",)),
    "sphere": _Part({"radius": 1}, ("radius",)),
    "cylinder": _Part({"radius": 1, "length": 1}, ("radius", "length")),
    "capsule": _Part({"radius": 1, "length": 1}, ("radius", "length")),
    "mesh": _Part({"scale": 3}, ("filename",)),
}
_JOINT = {
    "parent": _Part(needed=("link",)),
    "child": _Part(needed=("link",)),
    "origin": _ORIGIN,
    "axis": _Part({"xyz": 3}),
    "limit": _part_of(JointLimits),
    "safety_controller": _part_of(JointSafetyController),
    "calibration": _part_of(JointCalibration),
    "mimic": _part_of(JointMimic, "joint"),
    "dynamics": _part_of(JointDynamics),
}


def refused_by_readers(robot: XmlElement) -> Iterator[Refused]:
    """Yield what readers refuse of a robot, in the order of its elements."""
    taken: dict[tuple[str, str], XmlElement] = {}
    for element in robot.children:
        faults = _FAULTS.get(element.tag)
        if faults is None:
            continue
        yield from _below(element, _in_name(element, taken))
        yield from _below(element, faults(element))


def _in_name(element: XmlElement, taken: dict[tuple[str, str], XmlElement]) -> Iterator[Refused]:
    name = element.get("name")
    if name is None:
        # urdfdom goes on without a material that has none.
        if element.tag != "material":
            yield _lacks(element, "'name'")
        return
    first = taken.setdefault((element.tag, name), element)
    if first is not element:
        notes = [Note("the other is here", first.span)]
        where = element.attributes["name"].span
        yield Refused(NAME_IS_TAKEN.at(where, tag=element.tag, name=name, notes=notes), ())


def _in_link(link: XmlElement) -> Iterator[Refused]:
    if inertial := _first(link, "inertial"):
        yield from _below(inertial, _in_inertial(inertial))
    for shape in link.children:
        if shape.tag in ("visual", "collision"):
            yield from _below(shape, _in_shape(shape))


def _in_inertial(inertial: XmlElement) -> Iterator[Refused]:
    for tag in ("mass", "inertia"):
        if _first(inertial, tag) is None:
            yield _lacks(inertial, f"<{tag}>")
    yield from _in_parts(inertial, _INERTIAL)


def _in_shape(shape: XmlElement) -> Iterator[Refused]:
    yield from _in_parts(shape, {"origin": _ORIGIN})
    geometry = _first(shape, "geometry")
    if geometry is None:
        yield _lacks(shape, "<geometry>")
    elif body := next(iter(geometry.children), None):
        if part := _SHAPES.get(body.tag):
            yield from _below(geometry, _below(body, _in_part(body, part)))
    else:
        yield from _below(geometry, [_lacks(geometry, "shape, such as <box size='1 1 1'/>")])


def _in_joint(joint: XmlElement) -> Iterator[Refused]:
    kind = joint.get("type")
    if kind is None:
        yield _lacks(joint, "'type'")
    elif kind not in TYPES_OF_JOINTS:
        where = joint.attributes["type"].span
        yield Refused(NO_TYPE_OF_JOINT.at(where, name=kind, near=TYPES_OF_JOINTS), ())
    for tag in ("parent", "child"):
        if _first(joint, tag) is None:
            yield _lacks(joint, f"<{tag} link='...'>")
    parts = dict(_JOINT)
    if kind in HAVE_NO_AXIS:
        del parts["axis"]
    if kind in NEED_LIMITS:
        # What the limits of such a joint lack is told of the robot.
        parts["limit"] = _JOINT["limit"]._replace(needed=())
    yield from _in_parts(joint, parts)


def _in_parts(owner: XmlElement, parts: Mapping[str, _Part]) -> Iterator[Refused]:
    for tag, part in parts.items():
        if element := _first(owner, tag):
            yield from _below(element, _in_part(element, part))


def _in_part(element: XmlElement, part: _Part) -> Iterator[Refused]:
    missing = [repr(name) for name in part.needed if element.get(name) is None]
    if missing:
        yield _lacks(element, " and no ".join(missing))
    for name, count in part.numbers.items():
        text = element.get(name)
        if text is not None and not _are_numbers(text, count):
            yield _no_numbers(element, element.attributes[name], count)


def _are_numbers(text: str, count: int) -> bool:
    words = text.split()
    return len(words) == count and all(number_of(word) is not None or _UNBOUNDED.fullmatch(word) for word in words)


def _no_numbers(element: XmlElement, attribute: XmlAttribute, count: int) -> Refused:
    text = attribute.value
    expected = "one number" if count == 1 else f"{count} numbers with spaces between them"
    meant = [" ".join(text.replace(",", other).split()) for other in ". " if "," in text]
    way_out = next((f"; write '{one}'" for one in meant if _are_numbers(one, count)), "")
    told = NO_NUMBERS.at(
        attribute.span, name=attribute.name, tag=element.tag, expected=expected, text=text, way_out=way_out
    )
    return Refused(told, ())


def _lacks(element: XmlElement, what: str) -> Refused:
    return Refused(LACKS_PART.at(element.span, tag=element.tag, what=what), ())


def _first(element: XmlElement, tag: str) -> XmlElement | None:
    return next((child for child in element.children if child.tag == tag), None)


def _below(element: XmlElement, faults: Iterable[Refused]) -> Iterator[Refused]:
    """Yield faults of an element as those of what it stands in."""
    for fault in faults:
        yield fault._replace(path=(element, *fault.path))


def _in_material(_: XmlElement) -> Iterator[Refused]:
    """Yield nothing: of what a material says readers refuse no robot."""
    return iter(())


_FAULTS: Mapping[str, Callable[[XmlElement], Iterator[Refused]]] = {
    "material": _in_material,
    "link": _in_link,
    "joint": _in_joint,
}
