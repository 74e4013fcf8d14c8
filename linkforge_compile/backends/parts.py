"""The parts of a robot that hold more than numbers, at any depth: looked for once, for whoever looks into them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import cache
from operator import attrgetter
from typing import TYPE_CHECKING, TypeAlias

from linkforge_compile.backends.element import inside_of
from linkforge_compile.core.models.interface import Interface
from linkforge_compile.core.models.link import Link
from linkforge_compile.core.part import Element
from linkforge_compile.core.part import Part as BasePart
from linkforge_compile.frozen import fields
from linkforge_compile.named_tuple import NamedTuple
from linkforge_compile.source import SourceRef

if TYPE_CHECKING:
    from linkforge_compile.core.models.robot import Robot

Part: TypeAlias = Element | Link | Interface
"""What becomes an XML element, and may hold what no field says."""


class Held(NamedTuple):
    """A part, where it was written, else what holds it, and the parts around it, outermost first.

    `said` are its fields with more in them than a number, by name, without those that every part has.
    """

    part: Part
    where: SourceRef | None
    around: tuple[Part, ...]
    said: list[tuple[str, object]]


class Worded(NamedTuple):
    """The parts that hold more than numbers, and those of them that hold what no field says."""

    parts: list[Held]
    with_extras: list[Held]


def worded_parts_of_urdf(robot: Robot) -> Worded:
    """Return the parts with more than numbers in them that the URDF of a robot writes."""
    return worded_parts_in(
        (
            tuple(robot.materials.values()),
            robot.links,
            robot.joints,
            robot.sensors,
            robot.transmissions,
            robot.ros2_controls,
            robot.gazebo_elements,
        )
    )


def worded_parts_in(value: object) -> Worded:
    """Return a part, or those in collections of them, and what is in these, `extra_inside` among them.

    Those that hold numbers alone, which are most, are left out: XML can write every one of these.
    """
    found = Worded([], [])
    _gather(value, None, (), found)
    return found


def _gather(value: object, where: SourceRef | None, around: tuple[Part, ...], found: Worded) -> None:
    if isinstance(value, _PARTS):
        _gather_part(value, where, around, found)
    elif isinstance(value, tuple):  # before what is asked of base classes, which takes long
        for inner in value:
            _gather(inner, where, around, found)
    elif isinstance(value, _HOLD_NONE):
        return
    elif isinstance(value, Mapping):
        for inner in value.values():
            _gather(inner, where, around, found)
    elif isinstance(value, Sequence):
        for inner in value:
            _gather(inner, where, around, found)


def _gather_part(part: Part, where: SourceRef | None, around: tuple[Part, ...], found: Worded) -> None:
    kind: type = part.__class__
    names, values_of, extras_of = _ways_into(kind)
    said = [pair for pair in zip(names, values_of(part), strict=True) if pair[1]] if names else []
    has_extras = any(extras_of(part))
    if not (said or has_extras):
        return
    where = part.source or where
    held = Held(part, where, around, said)
    found.parts.append(held)
    around = (*around, part)
    if has_extras:
        found.with_extras.append(held)
        _gather(inside_of(part), where, around, found)
    for _, inner in said:
        if inner.__class__ is not str:
            _gather(inner, where, around, found)


# A union takes three times as long to ask.
_PARTS = (Element, Link, Interface)

# What is neither one of them nor a collection.
_HOLD_NONE = (str, BasePart)

_Values: TypeAlias = Callable[[Part], tuple[object, ...]]


@cache
def _ways_into(kind: type) -> tuple[tuple[str, ...], _Values, _Values]:
    """Return the names of a class's own fields that may hold more than numbers, what gets their values, and extras.

    Half of the parts are of a class without such a field.
    """
    if issubclass(kind, Element | Link):
        own = (field for field in fields(kind) if field.name not in _EVERYWHERE)
        names = tuple(field.name for field in own if not _holds_numbers(str(field.type), is_compared=field.compare))
    else:
        names = ("parameters",)
    extras = tuple(name for name in _EXTRAS if hasattr(kind, name))
    return names, _getter(names), _getter(extras)


def _holds_numbers(kind: str, *, is_compared: bool) -> bool:
    """Whether a field holds neither parts nor text: its class refuses them, or it is how a file said it, unwritten."""
    return _NUMBERS.issuperset(kind.split(" | ")) or (kind == "bool" and not is_compared)


def _getter(names: tuple[str, ...]) -> _Values:
    return attrgetter(*names) if len(names) > 1 else lambda part: tuple([getattr(part, name) for name in names])


_NUMBERS = frozenset({"float", "int", "Vector3", "None"})
"""What constructors refuse anything else for; a truth is taken as it comes, and written."""

_EXTRAS = ("extra_attributes", "extra_elements", "extra_inside")

_EVERYWHERE = frozenset(field.name for field in fields(Element))
