"""Values of a robot in words, for people, and as JSON, for programs."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import MISSING, Field, fields, is_dataclass

from linkforge_compile.compare.difference import Plain
from linkforge_compile.compare.measures import ANGLE, BARE, LENGTH, Measure, measure_of, number_told
from linkforge_compile.core.models.geometry import Mesh, Transform, Vector3
from linkforge_compile.core.models.interface import Interface
from linkforge_compile.core.models.joint import Joint
from linkforge_compile.core.models.link import Link
from linkforge_compile.core.models.material import Color
from linkforge_compile.core.models.ros2_control import Ros2Control

LONGEST = 70
"""Characters that a word of somebody else, such as raw XML, may take in a line."""

_KEYS = {
    "visuals": "visual",
    "collisions": "collision",
    "link_name": "link",
    "resource": "file",
    "ros2_controls": "ros2_control",
    "gazebo_elements": "gazebo",
    "extra_elements": "extra",
}
NO_PART_OF_IT = frozenset({"stated", "interfaces_stated", "version_stated"})
"""Fields that say which others are written with their default, and are told as those."""


def key_of_field(field: str) -> str:
    """Return the key under which the language has a field of the IR."""
    return _KEYS.get(field, field.removesuffix("_info"))


def said_fields(part: object) -> tuple[str, ...]:
    """Return the fields of a part, or of an interface, that say something of the robot."""
    if isinstance(part, Interface):
        return "parameters", "extra_attributes", "extra_elements", "extra_inside"
    assert is_dataclass(part)
    own = (one.name for one in fields(part) if one.compare and not one.name.startswith("_"))
    return tuple(name for name in own if name not in NO_PART_OF_IT)


def is_part(value: object) -> bool:
    """Whether a value has fields of its own."""
    return isinstance(value, Interface) or (is_dataclass(value) and not isinstance(value, type))


def told(value: object, measure: Measure = BARE, *, slides: bool = False) -> str:
    """Return a value in a few words; `slides` says that it is about a prismatic joint."""
    match value:
        case None:
            return "none"
        case bool():
            return "yes" if value else "no"
        case int() | float():
            return number_told(value, measure)
        case Interface():
            return str(value)
        case str():
            return shortened(value) or "''"
        case Vector3() | Color():
            numbers = value.to_tuple()
            return f"{' '.join(number_told(number * measure.shown) for number in numbers)} {measure.unit}".rstrip()
        case Transform():
            return f"at {told(value.xyz, LENGTH)}, rpy {told(value.rpy, ANGLE)}"
        case Mapping():
            return ", ".join(f"{name} {told(one)}" for name, one in value.items()) or "nothing"
        case tuple() | list():
            return " ".join(told(one, measure) for one in value) or "nothing"
    return _part_told(value, slides=slides)


def shortened(text: str) -> str:
    """Return a text on one line of bearable length."""
    line = " ".join(text.split())
    return line if len(line) <= LONGEST else f"{line[: LONGEST - 1]}…"


def _part_told(part: object, *, slides: bool) -> str:
    match part:
        case Link():
            return _link_told(part)
        case Joint():
            return f"{part.type}, {part.parent} → {part.child}"
        case Mesh():
            return f"mesh {part.resource}" + (f" scaled {told(part.scale)}" if set(part.scale) != {1} else "")
        case Ros2Control():
            return _hardware_told(part)
        case _ if is_part(part):
            return shortened(", ".join(_fields_told(part, slides=slides)) or "as by default")
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
        f"; {verb} {' '.join(names)}" for verb, names in (("commands", commands), ("reads", states)) if names
    )


def _counted(counts: Iterable[tuple[int, str]]) -> Iterator[str]:
    return (f"{count} {what}{'s' if count > 1 else ''}" for count, what in counts if count)


def _fields_told(part: object, *, slides: bool) -> Iterator[str]:
    if shape := getattr(part, "type", None) if "type" not in said_fields(part) else None:
        yield f"{shape}"
    for one in fields(part) if is_dataclass(part) and not isinstance(part, type) else ():
        value: object = getattr(part, one.name)
        if one.name == "name" or one.name not in said_fields(part) or _is_default(one, value):
            continue
        key = key_of_field(one.name)
        if isinstance(value, tuple) and value and is_part(value[0]):
            yield f"{len(value)} {key}"
        elif is_part(value) and not isinstance(value, Vector3 | Color | Transform):
            yield f"{key} ({told(value, slides=slides)})"
        else:
            yield f"{key} {told(value, measure_of(type(part), one.name, slides=slides))}"


def _is_default(field: Field[object], value: object) -> bool:
    return value is None or (field.default is not MISSING and value == field.default)


def plain(value: object) -> Plain:
    """Return a value as JSON can hold it: a part as an object of what it says, in the language's keys."""
    match value:
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
    values = {key_of_field(name): plain(getattr(part, name)) for name in said_fields(part)}
    return {key: value for key, value in values.items() if value is not None and value not in ([], {})}
