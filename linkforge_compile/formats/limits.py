"""Limits that formats of XML share: what cannot be written, is written twice, or is left out by simulators."""

from __future__ import annotations

from collections.abc import Callable, Container, Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from linkforge_compile.core.exceptions import FieldPath, RobotGeneratorError
from linkforge_compile.core.fields import field_specs
from linkforge_compile.core.models.geometry import Material, Transform
from linkforge_compile.core.models.joint import Joint, JointType
from linkforge_compile.core.models.link import Collision, Inertial, Link, Visual
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.models.ros2_control import Ros2Control
from linkforge_compile.core.models.transmission import Transmission
from linkforge_compile.core.part import Inside, attribute_pairs
from linkforge_compile.diagnostics import Diagnostic, Note
from linkforge_compile.diagnostics.codes.formats import RAW_NAME_IS_TAKEN, SECOND_OF_ONE, UNDECLARED_PREFIX, UNWRITABLE
from linkforge_compile.formats.element import (
    Extended,
    RestatedAttributeError,
    inside_of,
    numbering_insides,
    place_of_attribute,
    raw_texts,
)
from linkforge_compile.formats.kinematic_tree import leader_of
from linkforge_compile.formats.parts import Doubtful, Held, Part, unwritable_raw, unwritable_texts
from linkforge_compile.formats.raw import well_formed_elements
from linkforge_compile.formats.xml_document import InsideError
from linkforge_compile.source import Key, SourceRef, Span
from linkforge_compile.source.xml_tree import XmlElement


def check_texts(robot: Robot, doubtful: Doubtful) -> Iterator[Diagnostic]:
    """XML holds no control characters, extras must be well-formed, and only some names can be those of tags."""
    yield from unwritable_raw(robot, robot.source)
    yield from unwritable_texts(doubtful.parts)


def check_attributes(parts: Sequence[Held], robot: Robot, render: Callable[[], str]) -> Iterator[Diagnostic]:
    """An element has each attribute once: `extra_attributes` cannot repeat one that a field writes.

    Only rendering knows the attributes of an element, so a robot that has extra ones is rendered to find out.
    The same is true of the elements that `extra_inside` names.
    """
    extended = [part for part, *_ in parts if _is_extended(part)]
    if not (robot.extra_attributes or extended):
        return
    numbered: list[Inside] = []
    try:
        with numbering_insides() as numbered:
            render()
    except RestatedAttributeError as error:
        yield UNWRITABLE.at(*place_of_attribute(error.name, error.source), Key(error.name), reason=error)
    except InsideError as error:
        for fault in (error, *error.others):
            faulty = numbered[int(fault.id)]
            holders = (part for part in extended if any(one is faulty for one in inside_of(part)))
            holder = next(holders, robot)
            yield UNWRITABLE.at(holder.source, "extra_inside", Key(fault.key), reason=fault)
    except RobotGeneratorError:
        return  # the check of texts reports it


def _is_extended(part: Part) -> bool:
    """Whether a part has extra attributes or additions to elements inside; an addition is no part by itself."""
    return not isinstance(part, Inside) and bool(part.extra_attributes or inside_of(part))


def check_written_twice(parts: Sequence[Held]) -> Iterator[Diagnostic]:
    """An element of which there can be one is written by its field or as raw XML, and not twice."""
    if any(part.extra_elements for part, *_ in parts):
        yield from written_twice(parts)


_OF_XML = frozenset({"xml", "xmlns"})
_DECLARATION = "xmlns:"


def undeclared_prefixes(root: Extended, parts: Iterable[Held]) -> Iterator[Diagnostic]:
    """Yield a warning for each prefix in a root element or its parts that is not declared around it."""
    known = _OF_XML | _declared_by(_names(root))
    yield from _in_extras(root, known, root.source)
    for part, where, around, _ in parts:
        if part.extra_attributes or part.extra_elements:
            names = (name for holder in (*around, part) for name in _names(holder))
            yield from _in_extras(part, known | _declared_by(names), where)


def _in_extras(part: Extended, known: frozenset[str], where: SourceRef | None) -> Iterator[Diagnostic]:
    for name in _names(part):
        yield from _report(_unknown([name], known), *place_of_attribute(name, where), Key(name))
    for text, source, path in raw_texts(part, where):
        # Only what holds a colon is read once more.
        yield from _report(_in_xml(text, known) if ":" in text else (), source, *path)


def _names(part: Extended) -> list[str]:
    return [name for name, _ in attribute_pairs(part.extra_attributes)]


def _in_xml(text: str, known: frozenset[str]) -> Iterator[str]:
    """Yield the prefixes of raw XML that nothing declares; none of malformed XML, which `limits` reports."""

    def unknown(node: XmlElement, known: frozenset[str]) -> Iterator[str]:
        names = list(node.values)
        known |= _declared_by(names)
        yield from _unknown([node.tag, *names], known)
        for child in node.children:
            yield from unknown(child, known)

    for node in well_formed_elements(text):
        yield from unknown(node, known)


def _declared_by(names: Iterable[str]) -> frozenset[str]:
    return frozenset(name.removeprefix(_DECLARATION) for name in names if name.startswith(_DECLARATION))


def _unknown(names: Iterable[str], known: frozenset[str]) -> Iterator[str]:
    for name in names:
        prefix, colon, _ = name.partition(":")
        if colon and prefix not in known:
            yield prefix


def _report(prefixes: Iterable[str], where: SourceRef | None, *path: str | int) -> Iterator[Diagnostic]:
    for prefix in dict.fromkeys(prefixes):
        yield UNDECLARED_PREFIX.at(where, *path, prefix=prefix)


def _fields_by_tag(kind: type) -> Mapping[str, str]:
    """Return the field of a class that writes each tag of which its element has one at most."""
    paths = {name: spec.xml or "" for name, spec in field_specs(kind).items() if not spec.container}
    return {path.partition("/")[0]: name for name, path in paths.items() if path and path[0] not in "@."}


_WITH_SINGLE_CHILDREN = (Link, Inertial, Visual, Collision, Material, Joint, Ros2Control, Transmission)

_ONE_OF: Mapping[type[Part], Mapping[str, str]] = {kind: _fields_by_tag(kind) for kind in _WITH_SINGLE_CHILDREN}


def written_twice(parts: Iterable[Held]) -> Iterator[Diagnostic]:
    """Yield a warning for each such element that raw XML of parts says again."""
    for part, where, *_ in parts:
        if part.extra_elements and (fields := _ONE_OF.get(type(part))):
            yield from _written_again(part, where, fields)


def _written_again(part: Part, where: SourceRef | None, fields: Mapping[str, str]) -> Iterator[Diagnostic]:
    first = {tag: _place(where, field) for tag, field in fields.items() if _is_written(part, field, where)}
    for text, source, path in raw_texts(part, where):
        for tag in (node.tag for node in well_formed_elements(text)):
            if tag not in fields:
                continue
            if tag not in first:
                first[tag] = _place(source, *path)
                continue
            place = first[tag]
            yield SECOND_OF_ONE.at(source, *path, tag=tag, notes=[Note("the first is here", place)] if place else [])


def _is_written(part: Part, field: str, where: SourceRef | None) -> bool:
    value = getattr(part, field)
    if isinstance(part, Joint) and where and where.at(field) == where.span:
        return False  # the value stands in for one that is missing, which is reported
    return value.is_written if isinstance(value, Transform) else value is not None


def _place(source: SourceRef | None, *path: str | int) -> Span | None:
    return source.at(*path) if source else None


def check_raw_names(robot: Robot) -> Iterator[Diagnostic]:
    """No two links, joints or materials of a URDF have one name: urdfdom refuses the robot."""
    named: Mapping[str, Iterable[Link | Joint | Material]] = {
        "link": robot.links,
        "joint": robot.joints,
        "material": robot.materials.values(),
    }
    taken = {
        (tag, part.name): part.source.span if part.source else None for tag, parts in named.items() for part in parts
    }
    for text, source, path in raw_texts(robot, robot.source):
        place = source.at(*path) if source else None
        for tag, name in _named_in(text):
            if tag not in named:
                continue
            if (tag, name) not in taken:
                taken[tag, name] = place
                continue
            first = taken[tag, name]
            notes = [Note("the other is here", first)] if first else []
            yield RAW_NAME_IS_TAKEN.at(source, *path, tag=tag, name=name, notes=notes)


def _named_in(text: str) -> Iterator[tuple[str, str]]:
    """Yield the tag and name of each element of raw XML that has one."""
    for node in well_formed_elements(text):
        yield from ((node.tag, value) for key, value in node.values.items() if key == "name")


class Loss(NamedTuple):
    """What kind of part is omitted, the name of the part that has it, and its place."""

    parts: str
    name: str
    source: SourceRef | None
    path: FieldPath = ()


def joint_losses(joint: Joint, robot: Robot, *, loose: Container[str]) -> Iterator[Loss]:
    """Yield what no simulator has of a joint; `loose` are the types that have neither limits nor dynamics there."""
    limits, dynamics = joint.limits, joint.dynamics
    if joint.safety_controller:
        yield Loss("safety controllers", joint.name, joint.source, ("safety_controller",))
    if joint.calibration:
        yield Loss("calibrations", joint.name, joint.source, ("calibration",))
    if joint.mimic and robot.has_joint(joint.mimic.joint) and leader_of(joint, robot) is None:
        yield Loss("mimic with a joint of other than one axis", joint.name, joint.mimic.source or joint.source)
    if joint.type in loose and limits:
        yield Loss(f"limits of {joint.type} joints", joint.name, limits.source or joint.source)
    if joint.type in loose and dynamics and (dynamics.damping or dynamics.friction):
        yield Loss(f"dynamics of {joint.type} joints", joint.name, dynamics.source or joint.source)


_RAW_XML = "raw XML of a URDF"

_WITHOUT_LOSS = ("xmlns", "quat_xyzw")
"""Raw attributes that only a URDF needs: namespaces, and a turn that `rpy` has as well."""


def lost_xml(robot: Robot, parts: Iterable[Held]) -> Iterator[Loss]:
    """Yield the first raw XML or attribute of the robot and of each part; `parts` has what is inside, too.

    What fixed joints have is an axis, limits or whether to keep the joint, none of which is a loss.
    """
    yield from _first(robot, robot.name, robot.source)
    for held in parts:
        if any(isinstance(part, Joint) and part.type == JointType.FIXED for part in (held.part, *held.around)):
            continue
        names = (getattr(part, "name", None) for part in (held.part, *reversed(held.around)))
        yield from _first(held.part, next(filter(None, names), robot.name), held.where)


def _first(part: Extended, name: str, where: SourceRef | None) -> Iterator[Loss]:
    for _, place, keys in raw_texts(part, where):
        yield Loss(_RAW_XML, name, place, keys)
        return
    for attribute, _ in attribute_pairs(part.extra_attributes):
        if not attribute.startswith(_WITHOUT_LOSS):
            source, *path = place_of_attribute(attribute, where)
            yield Loss(_RAW_XML, name, source, (*path, attribute))
            return
