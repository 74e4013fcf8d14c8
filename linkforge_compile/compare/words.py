"""Values of a robot in words, for people, and as JSON, for programs."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import MISSING, Field, fields, is_dataclass
from itertools import takewhile

from linkforge_compile.compare.difference import Plain
from linkforge_compile.compare.measures import ANGLE, BARE, LENGTH, Measure, measure_of, number_told
from linkforge_compile.compare.raw_parts import RawElement
from linkforge_compile.compare.said import is_part, key_of_field, said_fields, said_value
from linkforge_compile.core.models.collision_rules import CollisionPair, LinkSphereApproximation
from linkforge_compile.core.models.gazebo import GazeboElement
from linkforge_compile.core.models.geometry import Mesh, Transform, Vector3
from linkforge_compile.core.models.interface import Interface
from linkforge_compile.core.models.joint import Joint
from linkforge_compile.core.models.link import Link
from linkforge_compile.core.models.material import Color
from linkforge_compile.core.models.planning import Chain, JointProperty
from linkforge_compile.core.models.ros2_control import Ros2Control

LONGEST = 70
"""Characters that a word of somebody else, such as raw XML, may take in a line."""
_LONGEST_PART = 120
"""Characters of what a part says."""
_LEAD = 20
"""How many of them stand before the place from which two long texts differ."""


def told(value: object, measure: Measure = BARE, *, slides: bool = False, digits: int = 6) -> str:
    """Return a value in a few words; `slides` says that it is about a prismatic joint."""
    match value:
        case None:
            return "none"
        case bool():
            return "yes" if value else "no"
        case int() | float():
            return number_told(value, measure, digits)
        case Interface():
            return str(value)
        case str():
            return shortened(value) or "''"
        case Vector3() | Color():
            bare = Measure("", measure.shown)
            numbers = (number_told(number, bare, digits) for number in value.to_tuple())
            return f"{' '.join(numbers)} {measure.unit}".rstrip()
        case Transform():
            return _pose_told(value)
        case Mapping():
            return ", ".join(f"{name} {told(one)}" for name, one in value.items()) or "nothing"
        case tuple() | list():
            return " ".join(told(one, measure, digits=digits) for one in value) or "nothing"
        case RawElement():
            return shortened(value.written)
    return _part_told(value, slides=slides)


def texts_told(before: str, after: str) -> tuple[str, str]:
    """Return two different texts on a line each, long ones from shortly before they differ."""
    one, other = (" ".join(text.split()) for text in (before, after))
    if one == other:
        one, other = as_json(before), as_json(after)
    if max(len(one), len(other)) > LONGEST:
        same = sum(1 for _ in takewhile(lambda pair: pair[0] == pair[1], zip(one, other, strict=False)))
        start = max(0, same - _LEAD)
        one, other = (shortened(f"…{text[start:]}" if start else text) for text in (one, other))
    return one or "''", other or "''"


def as_json(value: object) -> str:
    return json.dumps(plain(value), ensure_ascii=False)


def shortened(text: str, longest: int = LONGEST) -> str:
    """Return a text on one line of bearable length."""
    line = " ".join(text.split())
    if len(line) <= longest:
        return line
    # Of a path both ends matter.
    end = 0 if " " in line else longest // 2
    return f"{line[: longest - 1 - end]}…{line[len(line) - end :]}"


def _pose_told(pose: Transform) -> str:
    facts = [f"at {told(pose.xyz, LENGTH)}"] if any(pose.xyz) else []
    facts += [f"rpy {told(pose.rpy, ANGLE)}"] if any(pose.rpy) else []
    return ", ".join(facts) or "at the origin"


def _part_told(part: object, *, slides: bool) -> str:
    match part:
        case Link():
            return _link_told(part)
        case Joint():
            return f"{part.type}, {part.parent} → {part.child}"
        case Chain() if not (part.extra_attributes or part.extra_elements or part.extra_inside):
            return f"{part.base_link} → {part.tip_link}"
        case Mesh():
            return f"mesh {part.resource}" + (f" scaled {told(part.scale)}" if set(part.scale) != {1} else "")
        case Ros2Control():
            return _hardware_told(part)
        case _ if is_part(part):
            return shortened(", ".join(_fields_told(part, slides=slides)) or "as by default", _LONGEST_PART)
    return shortened(str(part))


def _link_told(link: Link) -> str:
    facts = [number_told(link.mass, Measure("kg"))] if link.inertial else []
    facts += _counted(((len(link.visuals), "visual"), (len(link.collisions), "collision")))
    return ", ".join(facts) or "a frame"


def _hardware_told(hardware: Ros2Control) -> str:
    counts = ((len(hardware.joints), "joint"), (len(hardware.sensors), "sensor"), (len(hardware.gpios), "gpio"))
    facts = [f"{hardware.type} of {hardware.hardware_plugin}", *_counted(counts)]
    commanded = (*hardware.joints, *hardware.gpios)
    commands = dict.fromkeys(str(name) for one in commanded for name in one.command_interfaces)
    states = dict.fromkeys(str(name) for one in commanded for name in one.state_interfaces)
    states |= dict.fromkeys(str(name) for one in hardware.sensors for name in one.state_interfaces)
    return ", ".join(facts) + "".join(
        f"; {verb} {shortened(' '.join(names))}" for verb, names in (("commands", commands), ("reads", states)) if names
    )


def _counted(counts: Iterable[tuple[int, str]]) -> Iterator[str]:
    return (f"{count} {what}{'s' if count > 1 else ''}" for count, what in counts if count)


def _fields_told(part: object, *, slides: bool) -> Iterator[str]:
    if shape := getattr(part, "type", None) if "type" not in said_fields(part) else None:
        yield f"{shape}"
    for one in fields(part) if is_dataclass(part) and not isinstance(part, type) else ():
        value: object = getattr(part, one.name)
        if one.name in _IN_ITS_KEY.get(type(part), ("name",)) or one.name not in said_fields(part):
            continue
        if _is_default(one, value):
            continue
        key = key_of_field(one.name)
        if isinstance(value, tuple) and value and is_part(value[0]):
            yield _members_told(key, value)
        elif key == "geometry" or isinstance(value, Transform):
            yield told(value)
        elif is_part(value) and not isinstance(value, Vector3 | Color):
            yield f"{key} ({told(value, slides=slides)})"
        else:
            yield f"{key} {told(value, measure_of(type(part), one.name, slides=slides))}"


_IN_ITS_KEY: Mapping[type, Sequence[str]] = {
    GazeboElement: ("reference",),
    CollisionPair: ("link1", "link2"),
    JointProperty: ("joint_name", "property_name"),
    LinkSphereApproximation: ("link",),
}
"""The fields that the path of a part says; of all others its name."""


def _members_told(key: str, members: Sequence[object]) -> str:
    names = [name for one in members if isinstance(name := getattr(one, "name", None), str)]
    if len(names) == len(members):
        return shortened(f"{key} {' '.join(names)}")
    return " ".join(_counted(((len(members), key.removesuffix("s")),)))


def _is_default(field: Field[object], value: object) -> bool:
    return value is None or (field.default is not MISSING and value == field.default)


def plain(value: object) -> Plain:
    """Return a value as JSON can hold it: a part as an object of what it says, in the language's keys."""
    match value:
        case RawElement():
            return value.written
        case Interface():
            parts: dict[str, Plain] = {"name": str(value)}
            return {**parts, **_plain_fields(value)}
        case None | bool() | int() | float() | str():
            return value
        case Vector3() | Color():
            return list(value.to_tuple())
        case Mapping():
            return {str(name): plain(one) for name, one in value.items()}
        case tuple() | list():
            return [plain(one) for one in value]
        case _ if is_part(value):
            return _plain_fields(value)
    return str(value)


def _plain_fields(part: object) -> dict[str, Plain]:
    values = {key_of_field(name): plain(said_value(part, name)) for name in said_fields(part)}
    return {key: value for key, value in values.items() if value is not None and value not in ([], {})}
