"""Compare two robots, section by section."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import TypeAlias

from linkforge_compile.compare.context import TOLERANCE, CompareContext
from linkforge_compile.compare.derived import order_differences, pose_differences, tensor_differences
from linkforge_compile.compare.difference import Difference, Kind, describe, to_plain
from linkforge_compile.compare.fields import (
    BARE,
    RawElement,
    compared_fields,
    compared_value,
    describe_change,
    is_near,
    is_part,
    key_of_field,
    position_measure,
    spell_same_numbers,
    xml_number,
)
from linkforge_compile.compare.matching import Renames, apply_renames, find_renames, key_of_member, pair_members
from linkforge_compile.core.models.geometry import Color, Material, Transform, Vector3
from linkforge_compile.core.models.joint import Joint, JointType
from linkforge_compile.core.models.link import InertiaTensor, LinkPhysics
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.models.ros2_control import Interface
from linkforge_compile.core.models.sensor import SensorNoise
from linkforge_compile.core.models.srdf import GroupState
from linkforge_compile.core.models.transmission import TransmissionActuator, TransmissionJoint

Path: TypeAlias = tuple[str, ...]

_PADDED = re.compile(r"(?<=\d)e-0+(?=\d)")
"""A negative exponent as Python writes it, 1e-08; the language writes 1e-8, which no reader of a number tells apart."""


def walk(path: Path, before: object, after: object, context: CompareContext) -> Iterator[Difference]:
    """Yield the differences between two values at a path."""
    match before, after:
        case (bool(), _) | (_, bool()):
            yield from _compare_leaves(path, before, after, context)
        case (int() | float(), int() | float()):
            if not is_near(before, after, context.tolerance):
                text = _describe_numbers(before, after, context)
                yield Difference(Kind.CHANGED, path, before, after, text)
        case (Transform(), Transform()):
            yield from pose_differences(path, before, after, context.tolerance)
            yield from _compare_fields(path, before, after, context, ("xyz", "rpy"))
        case (InertiaTensor(), InertiaTensor()):
            yield from tensor_differences(path, before, after, context.tolerance)
            yield from _compare_fields(path, before, after, context, ("ixx", "iyy", "izz", "ixy", "ixz", "iyz"))
        case (Vector3() | Color(), Vector3() | Color()):
            yield from _compare_vectors(path, before, after, context)
        case (Interface(), Interface()):
            yield from _compare_fields(path, before, after, context)
        case (Mapping(), Mapping()):
            yield from _compare_mappings(path, before, after, context)
        case (str(), _) | (_, str()):
            yield from _compare_leaves(path, before, after, context)
        case (tuple() | list(), tuple() | list()):
            yield from _compare_members(path, before, after, context)
        case _ if type(before) is type(after) and is_part(before):
            yield from _compare_parts(path, before, after, context)
        case _:
            yield from _compare_leaves(path, before, after, context)


def _compare_leaves(path: Path, before: object, after: object, context: CompareContext) -> Iterator[Difference]:
    if before == after and isinstance(before, bool) == isinstance(after, bool):
        return
    if _is_same_in_xml(before, after, context):
        return
    was, now = context.describe(before, after)
    kind, text = Kind.CHANGED, _describe_xml_numbers(before, after, context) or f"{was} → {now}"
    if before is None:
        kind, text = Kind.ADDED, now
    elif after is None:
        kind, text = Kind.REMOVED, was
    elif path[0] == "joints" and path[2:] == ("parent",):
        kind = Kind.MOVED
    yield Difference(kind, path, to_plain(before), to_plain(after), text)


def _is_same_in_xml(before: object, after: object, context: CompareContext) -> bool:
    if not context.in_xml or not isinstance(before, str) or not isinstance(after, str):
        return False
    if context.as_spelt:
        return _PADDED.sub("e-", before) == _PADDED.sub("e-", after)
    return spell_same_numbers(before, after, context.tolerance)


def _describe_xml_numbers(before: object, after: object, context: CompareContext) -> str:
    """Return the change between two different numbers that are texts in XML; empty for other texts."""
    numbers = [xml_number(text) for text in (before, after) if context.in_xml and isinstance(text, str)]
    match numbers:
        case [float() as one, float() as other] if one != other:
            return describe_change(one, other, BARE)
    return ""


def _describe_numbers(before: float, after: float, context: CompareContext) -> str:
    was, now = context.measures
    # Between an angle and a length there is no meaningful difference.
    return describe_change(before, after, now) if was == now else " → ".join(context.describe(before, after))


def _compare_raw_elements(
    path: Path, before: RawElement, after: RawElement, context: CompareContext
) -> Iterator[Difference]:
    """Yield the differences in an element of raw XML; only the order of elements of the same tag matters."""
    context = context.for_tag(after.tag)
    yield from _compare_mappings(path, before.attributes, after.attributes, context)
    if len(before.texts) == len(after.texts):
        for one, other in zip(before.texts, after.texts, strict=True):
            yield from _compare_leaves(path, one, other, context)
    else:
        yield from _compare_leaves(path, before.texts, after.texts, context)
    were, are = _group_by_tag(before.children), _group_by_tag(after.children)
    for tag in dict.fromkeys((*are, *were)):
        yield from _compare_same_tag(path, were.get(tag, ()), are.get(tag, ()), context)


def _group_by_tag(elements: Sequence[RawElement]) -> Mapping[str, Sequence[RawElement]]:
    found: dict[str, list[RawElement]] = {}
    for element in elements:
        found.setdefault(element.tag, []).append(element)
    return found


def _compare_same_tag(
    path: Path, before: Sequence[RawElement], after: Sequence[RawElement], context: CompareContext
) -> Iterator[Difference]:
    """Yield the differences in the elements of one tag, paired by their names if all have one, else by order."""
    has_names = len(after) > 1 and all(one.name for one in (*before, *after))
    if len(before) != len(after) or has_names:
        yield from _compare_members(path, before, after, context)
        return
    for index, (one, other) in enumerate(zip(before, after, strict=True)):
        key = key_of_member(other) if key_of_member(one) == key_of_member(other) else other.tag
        suffix = [str(index)] if len(after) > 1 and key == other.tag else []
        yield from walk((*path, key, *suffix), one, other, context)


def _compare_parts(path: Path, before: object, after: object, context: CompareContext) -> Iterator[Difference]:
    match before, after:
        case (Joint(), Joint()):
            slides = before.type is JointType.PRISMATIC, after.type is JointType.PRISMATIC
            context = context._replace(slides=slides)
        case (TransmissionJoint(), TransmissionJoint()):
            context = context.for_joint(after.name)
        case (Material(), Material()) if path[0] != "materials" and _is_declared(before, after, context):
            return  # reported at the declaration
        case (RawElement(), RawElement()):
            yield from _compare_raw_elements(path, before, after, context)
            return
        case (GroupState(), GroupState()):
            yield from _compare_positions(path, before, after, context)
            yield from _compare_fields(path, before, after, context, ("joint_values",))
            return
    yield from order_differences(path, before, after)
    yield from _compare_fields(path, before, after, context)


def _is_declared(before: Material, after: Material, context: CompareContext) -> bool:
    declared = tuple(palette.get(before.name) for palette in context.palettes)
    return before.name == after.name and declared == (before, after)


def _compare_fields(
    path: Path, before: object, after: object, context: CompareContext, without: tuple[str, ...] = ()
) -> Iterator[Difference]:
    for name in compared_fields(before):
        if name in without:
            continue
        old, new = compared_value(before, name), compared_value(after, name)
        # A shape has its own tag in the path, unless that has changed.
        is_same_shape = name == "geometry" and type(old) is type(new)
        key = str(getattr(old, "type", name)) if is_same_shape else key_of_field(type(before), name)
        yield from walk((*path, key), old, new, context.for_field(before, name))
    yield from stated_differences(path, before, after, context)


def stated_differences(path: Path, before: object, after: object, context: CompareContext) -> Iterator[Difference]:
    """Yield the fields with default values that only one of two parts writes out."""
    were, are = _stated_fields(before), _stated_fields(after)
    for name in dict.fromkeys((*are, *were)):
        old, new = getattr(before, name, None), getattr(after, name, None)
        if (name in were) != (name in are) and old == new:
            here, about_field = (*path, key_of_field(type(before), name)), context.for_field(before, name)
            yield from walk(here, old if name in were else None, new if name in are else None, about_field)


def _stated_fields(part: object) -> tuple[str, ...]:
    """Return the fields that a part writes out although they have their default; there may be others among them."""
    match part:
        case LinkPhysics() | SensorNoise():
            return tuple(part.stated)
        case TransmissionJoint() | TransmissionActuator():
            return (*part.stated, "hardware_interfaces") if part.interfaces_stated else tuple(part.stated)
        case Robot():
            return ("version",) if part.is_version_written else ()
    return ()


def _compare_members(
    path: Path, before: Sequence[object], after: Sequence[object], context: CompareContext
) -> Iterator[Difference]:
    for key, one, other in pair_members(before, after):
        # A plain name or a raw text is shown at the list itself.
        is_text = isinstance(one or other, str) and not isinstance(one or other, Interface)
        here = path if is_text else (*path, key)
        if one is None or other is None:
            yield from _compare_leaves(here, one, other, context)
        else:
            yield from walk(here, one, other, context)


def _compare_mappings(
    path: Path, before: Mapping[str, object], after: Mapping[str, object], context: CompareContext
) -> Iterator[Difference]:
    for name in dict.fromkeys((*after, *before)):
        here = (*path, str(name))
        if name not in before:
            yield Difference(Kind.ADDED, here, None, to_plain(after[name]), describe(after[name]))
        elif name not in after:
            yield Difference(Kind.REMOVED, here, to_plain(before[name]), None, describe(before[name]))
        else:
            yield from _compare_items(here, before[name], after[name], context.for_tag(name))


def _compare_items(path: Path, before: object, after: object, context: CompareContext) -> Iterator[Difference]:
    """Yield the differences between two values of a mapping, where the order of a list matters."""
    match before, after:
        case (list() | tuple(), list() | tuple()) if len(before) == len(after):
            for index, (one, other) in enumerate(zip(before, after, strict=True)):
                yield from _compare_items((*path, str(index)), one, other, context)
        case (list() | tuple(), _) | (_, list() | tuple()):
            yield from _compare_leaves(path, before, after, context)
        case _:
            yield from walk(path, before, after, context)


def _compare_vectors(
    path: Path, before: Vector3 | Color, after: Vector3 | Color, context: CompareContext
) -> Iterator[Difference]:
    pairs = zip(before.to_tuple(), after.to_tuple(), strict=True)
    if not all(is_near(one, other, context.tolerance) for one, other in pairs):
        text = " → ".join(context.describe(before, after))
        yield Difference(Kind.CHANGED, path, to_plain(before), to_plain(after), text)
    yield from _compare_fields(path, before, after, context, tuple("xyzrgba"))


def _compare_positions(
    path: Path, before: GroupState, after: GroupState, context: CompareContext
) -> Iterator[Difference]:
    """Yield the differences between the joint positions of two group states."""
    for joint in dict.fromkeys((*after.joint_values, *before.joint_values)):
        was, now = (position_measure(slides=slides) for slides in context.for_joint(joint).slides)
        here = context._replace(measures=(was, now))
        old, new = before.joint_values.get(joint), after.joint_values.get(joint)
        if old is None or new is None or len(old) != len(new):
            yield from _compare_leaves((*path, joint), old, new, here)
        else:
            for index, positions in enumerate(zip(old, new, strict=True)):
                suffix = [str(index)] if len(old) > 1 else []
                yield from walk((*path, joint, *suffix), *positions, here)


def compare(
    before: Robot, after: Robot, *, tolerance: float = TOLERANCE, semantic: bool = True
) -> tuple[Difference, ...]:
    """Return the differences between two robots, in the order of the robot after.

    The order of named parts is not compared. `tolerance` is absolute for poses [m], [rad], and relative for other
    numbers. The semantic part is compared only if `semantic`.
    """
    renames = find_renames(before, after)
    were_prismatic, are_prismatic = (
        {joint.name for joint in robot.joints if joint.type is JointType.PRISMATIC} for robot in (before, after)
    )
    were_prismatic = {renames.joints.get(name, name) for name in were_prismatic}
    context = CompareContext(tolerance, (were_prismatic, are_prismatic), (before.materials, after.materials))
    return tuple(_compare_sections(before, after, renames, context, semantic=semantic))


def _compare_sections(
    before: Robot, after: Robot, renames: Renames, context: CompareContext, *, semantic: bool
) -> Iterator[Difference]:
    for field in compared_fields(after):
        if field == "semantic" and not semantic:
            continue
        if field in {"links", "joints"}:
            yield from _renamed_parts(field, renames.links if field == "links" else renames.joints)
        if field == "links":
            yield from _moved_links(before, after, renames)
        if field == "semantic":
            for (group, was), now in renames.states.items():
                path = ("semantic", "group_states", f"{group}/{now}")
                yield Difference(Kind.RENAMED, path, was, now, f"was '{was}'")
        old, new = _section(before, field, renames), _section(after, field, Renames({}, {}))
        yield from walk((key_of_field(Robot, field),), old, new, context.for_section(field))
        if field == "version":
            yield from stated_differences((), before, after, context)


def _section(robot: Robot, field: str, renames: Renames) -> object:
    if field == "semantic":
        semantic = robot.semantic
        # This repeats the robot's name, whose change is reported only once.
        is_repeated = semantic.robot_name == robot.name
        return apply_renames(semantic.with_fields(robot_name="") if is_repeated else semantic, renames)
    section = compared_value(robot, field)
    return apply_renames(tuple(section), renames) if isinstance(section, tuple) else section


def _renamed_parts(section: str, names: Mapping[str, str]) -> Iterator[Difference]:
    for old, new in names.items():
        yield Difference(Kind.RENAMED, (section, new), old, new, f"was '{old}'")


def _moved_links(before: Robot, after: Robot, renames: Renames) -> Iterator[Difference]:
    """Yield the links with another parent by another joint; the same joint reports its new parent itself."""
    old_names = {new: old for old, new in renames.links.items()}
    for link in after.links:
        if (old := old_names.get(link.name, link.name)) not in before.links:
            continue
        was, now = before.get_parent_joint(old), after.get_parent_joint(link.name)
        parent, other = renames.links.get(was.parent, was.parent) if was else None, now.parent if now else None
        is_same_joint = was and now and renames.joints.get(was.name, was.name) == now.name
        if parent != other and not is_same_joint:
            yield Difference(Kind.MOVED, ("links", link.name), parent, other, _describe_move(parent, other))


def _describe_move(before: str | None, after: str | None) -> str:
    was = "the root" if before is None else f"attached to '{before}'"
    now = "the root" if after is None else f"attached to '{after}'"
    return f"is {now}, was {was}"
