"""One difference between two robots, and values in words and as JSON."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import MISSING, Field, dataclass, fields, is_dataclass
from enum import StrEnum
from itertools import takewhile
from typing import TypeAlias

from linkforge_compile.compare.fields import (
    ANGLE,
    BARE,
    LENGTH,
    Measure,
    RawElement,
    compared_fields,
    compared_value,
    describe_number,
    is_part,
    key_of_field,
    measure_of,
)
from linkforge_compile.core.models.gazebo import GazeboElement
from linkforge_compile.core.models.geometry import Color, Mesh, Transform, Vector3
from linkforge_compile.core.models.joint import Joint
from linkforge_compile.core.models.link import Link
from linkforge_compile.core.models.ros2_control import Interface, Ros2Control
from linkforge_compile.core.models.srdf import Chain, JointProperty
from linkforge_compile.core.models.srdf_collisions import CollisionPair, LinkSphereApproximation

Plain: TypeAlias = "None | bool | int | float | str | list[Plain] | dict[str, Plain]"
"""A value that JSON can hold; numbers are in SI units."""


class Kind(StrEnum):
    """How a part or value of the robot before differs in the robot after."""

    ADDED = "added"
    REMOVED = "removed"
    RENAMED = "renamed"
    MOVED = "moved"
    CHANGED = "changed"


@dataclass(frozen=True)
class Difference:
    """A difference at one place.

    `path` is the path that `explain` accepts, such as `("joints", "elbow", "limits", "upper")`, with the names of the
    robot after, or of the robot before for what was removed. `before` and `after` are the exact values, None where
    there is none; they are names for a renamed part, and parent links for a moved one. `text` describes the
    difference: rounded, with units and the amount of the change.
    """

    kind: Kind
    path: tuple[str, ...]
    before: Plain
    after: Plain
    text: str


_MAX_TEXT = 70
"""Characters shown of a text, such as raw XML."""
_MAX_PART = 120
"""Characters shown of a part."""
_CONTEXT = 20
"""Characters shown before the first difference of two long texts."""


def describe(value: object, measure: Measure = BARE, *, slides: bool = False, digits: int = 6) -> str:
    """Return a value in a few words; `slides` is whether it is about a prismatic joint."""
    match value:
        case None:
            return "none"
        case bool():
            return "yes" if value else "no"
        case int() | float():
            return describe_number(value, measure, digits)
        case Interface():
            return str(value)
        case str():
            return shorten(value) or "''"
        case Vector3() | Color():
            bare = Measure("", measure.factor)
            numbers = (describe_number(number, bare, digits) for number in value.to_tuple())
            return f"{' '.join(numbers)} {measure.unit}".rstrip()
        case Transform():
            return _describe_pose(value)
        case Mapping():
            return ", ".join(f"{name} {describe(item)}" for name, item in value.items()) or "nothing"
        case tuple() | list():
            return " ".join(describe(item, measure, digits=digits) for item in value) or "nothing"
        case RawElement():
            return shorten(value.written)
    return _describe_part(value, slides=slides)


def describe_texts(before: str, after: str) -> tuple[str, str]:
    """Return two different texts on one line each; long ones start shortly before the first difference."""
    one, other = (" ".join(text.split()) for text in (before, after))
    if one == other:
        one, other = to_json(before), to_json(after)
    if max(len(one), len(other)) > _MAX_TEXT:
        same = sum(1 for _ in takewhile(lambda pair: pair[0] == pair[1], zip(one, other, strict=False)))
        start = max(0, same - _CONTEXT)
        one, other = (shorten(f"…{text[start:]}" if start else text) for text in (one, other))
    return one or "''", other or "''"


def shorten(text: str, limit: int = _MAX_TEXT) -> str:
    """Return a text on one line of at most `limit` characters."""
    line = " ".join(text.split())
    if len(line) <= limit:
        return line
    # A path has no spaces; both of its ends are shown.
    end = 0 if " " in line else limit // 2
    return f"{line[: limit - 1 - end]}…{line[len(line) - end :]}"


def _describe_pose(pose: Transform) -> str:
    facts = [f"at {describe(pose.xyz, LENGTH)}"] if any(pose.xyz) else []
    facts += [f"rpy {describe(pose.rpy, ANGLE)}"] if any(pose.rpy) else []
    return ", ".join(facts) or "at the origin"


def _describe_part(part: object, *, slides: bool) -> str:
    match part:
        case Link():
            return _describe_link(part)
        case Joint():
            return f"{part.type}, {part.parent} → {part.child}"
        case Chain() if not (part.extra_attributes or part.extra_elements or part.extra_inside):
            return f"{part.base_link} → {part.tip_link}"
        case Mesh():
            return f"mesh {part.resource}" + (f" scaled {describe(part.scale)}" if set(part.scale) != {1} else "")
        case Ros2Control():
            return _describe_hardware(part)
        case _ if is_part(part):
            return shorten(", ".join(_describe_fields(part, slides=slides)) or "as by default", _MAX_PART)
    return shorten(str(part))


def _describe_link(link: Link) -> str:
    facts = [describe_number(link.mass, Measure("kg"))] if link.inertial else []
    facts += _counted(((len(link.visuals), "visual"), (len(link.collisions), "collision")))
    return ", ".join(facts) or "a frame"


def _describe_hardware(hardware: Ros2Control) -> str:
    counts = ((len(hardware.joints), "joint"), (len(hardware.sensors), "sensor"), (len(hardware.gpios), "gpio"))
    facts = [f"{hardware.type} of {hardware.hardware_plugin}", *_counted(counts)]
    commanded = (*hardware.joints, *hardware.gpios)
    commands = dict.fromkeys(str(name) for one in commanded for name in one.command_interfaces)
    states = dict.fromkeys(str(name) for one in commanded for name in one.state_interfaces)
    states |= dict.fromkeys(str(name) for one in hardware.sensors for name in one.state_interfaces)
    return ", ".join(facts) + "".join(
        f"; {verb} {shorten(' '.join(names))}" for verb, names in (("commands", commands), ("reads", states)) if names
    )


def _counted(counts: Iterable[tuple[int, str]]) -> Iterator[str]:
    return (f"{count} {noun}{'s' if count > 1 else ''}" for count, noun in counts if count)


def _describe_fields(part: object, *, slides: bool) -> Iterator[str]:
    compared = compared_fields(part)
    if shape := getattr(part, "type", None) if "type" not in compared else None:
        yield f"{shape}"
    for field in fields(part) if is_dataclass(part) and not isinstance(part, type) else ():
        value: object = getattr(part, field.name)
        if field.name in _FIELDS_IN_PATH.get(type(part), ("name",)) or field.name not in compared:
            continue
        if _is_default(field, value):
            continue
        key = key_of_field(type(part), field.name)
        if isinstance(value, tuple) and value and is_part(value[0]):
            yield _describe_members(key, value)
        elif key == "geometry" or isinstance(value, Transform):
            yield describe(value)
        elif is_part(value) and not isinstance(value, Vector3 | Color):
            yield f"{key} ({describe(value, slides=slides)})"
        else:
            yield f"{key} {describe(value, measure_of(type(part), field.name, slides=slides))}"


_FIELDS_IN_PATH: Mapping[type, Sequence[str]] = {
    GazeboElement: ("reference",),
    CollisionPair: ("link1", "link2"),
    JointProperty: ("joint_name", "property_name"),
    LinkSphereApproximation: ("link",),
}
"""Fields that the path of a part shows already; `name` for all other classes."""


def _describe_members(key: str, members: Sequence[object]) -> str:
    names = [name for member in members if isinstance(name := getattr(member, "name", None), str)]
    if len(names) == len(members):
        return shorten(f"{key} {' '.join(names)}")
    return " ".join(_counted(((len(members), key.removesuffix("s")),)))


def _is_default(field: Field[object], value: object) -> bool:
    return value is None or (field.default is not MISSING and value == field.default)


def to_json(value: object) -> str:
    return json.dumps(to_plain(value), ensure_ascii=False)


def to_plain(value: object) -> Plain:
    """Convert a value to what JSON can hold; a part becomes an object with the keys of the language."""
    match value:
        case RawElement():
            return value.written
        case Interface():
            return {"name": str(value), **_plain_fields(value)}
        case None | bool() | int() | float() | str():
            return value
        case Vector3() | Color():
            return list(value.to_tuple())
        case Mapping():
            return {str(name): to_plain(item) for name, item in value.items()}
        case tuple() | list():
            return [to_plain(item) for item in value]
        case _ if is_part(value):
            return _plain_fields(value)
    return str(value)


def _plain_fields(part: object) -> dict[str, Plain]:
    values = {key_of_field(type(part), name): to_plain(compared_value(part, name)) for name in compared_fields(part)}
    return {key: value for key, value in values.items() if value is not None and value not in ([], {})}
