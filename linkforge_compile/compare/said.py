"""What a part of a robot says: its fields under the language's keys, each as it is compared."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import fields, is_dataclass

from linkforge_compile.compare.raw_parts import raw_parts
from linkforge_compile.core.models.interface import Interface

_KEYS = {
    "visuals": "visual",
    "chains": "chain",
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


def said_value(part: object, field: str) -> object:
    """Return what a part says in a field, as it is compared: raw XML as its elements, attributes by their names."""
    held: object = getattr(part, field)
    read_as = _READ_AS.get(field)
    return held if read_as is None or held is None else read_as(held)


def _as_interfaces(names: object) -> object:
    assert isinstance(names, Sequence)
    return tuple(map(Interface.of, names))


def _as_elements(texts: object) -> object:
    assert isinstance(texts, Sequence)
    return raw_parts(texts)


def _as_mapping(pairs: object) -> object:
    assert isinstance(pairs, Sequence)
    return dict(pairs)


_READ_AS: Mapping[str, Callable[[object], object]] = {
    "command_interfaces": _as_interfaces,
    "state_interfaces": _as_interfaces,
    "extra_attributes": _as_mapping,
    "extra_elements": _as_elements,
}
