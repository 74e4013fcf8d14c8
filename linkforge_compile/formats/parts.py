"""The parts of a robot that XML may be unable to write, at any depth: found once for all checks."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cache, partial
from operator import attrgetter
from types import NoneType
from typing import NamedTuple, TypeAlias

from linkforge_compile.core.exceptions import RobotGeneratorError
from linkforge_compile.core.fields import Number, Vector, field_specs
from linkforge_compile.core.models.link import Link, LinkPhysics
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.models.ros2_control import Interface
from linkforge_compile.core.part import Part as BasePart
from linkforge_compile.core.part import WithExtras, attribute_pairs
from linkforge_compile.diagnostics import Diagnostic, Note
from linkforge_compile.diagnostics.codes.formats import UNWRITABLE
from linkforge_compile.formats.element import (
    Extended,
    inside_of,
    place_of_attribute,
    raw_texts,
    require_attribute_name,
)
from linkforge_compile.formats.xml_text import RawXmlError, is_writable, require_writable
from linkforge_compile.source import Key, SourceRef

Part: TypeAlias = WithExtras | Link | Interface
"""What becomes an XML element, and may hold what no field says."""


class Held(NamedTuple):
    """A part, where it was written, else what holds it, and the parts around it, outermost first.

    `doubtful` are its fields, by name, with texts in them that XML may be unable to hold.
    """

    part: Part
    where: SourceRef | None
    around: tuple[Part, ...]
    doubtful: list[tuple[str, object]]


class Doubtful(NamedTuple):
    """The parts that may be unwritable, by their fields or what no field says, and those of them that say such."""

    parts: list[Held]
    with_extras: list[Held]


def doubtful_parts_of_urdf(robot: Robot) -> Doubtful:
    """Return such parts of what the URDF of a robot writes."""
    return doubtful_parts_in(
        tuple(robot.materials.values()),
        robot.links,
        robot.joints,
        robot.sensors,
        robot.transmissions,
        robot.ros2_controls,
        robot.gazebo_elements,
    )


def doubtful_parts_in(*sections: object) -> Doubtful:
    """Return such parts among parts, or collections of them, and what is in these, `extra_inside` among them.

    Those of numbers and plain texts alone, which are nearly all, are omitted: XML can write every one of these.
    """
    found = Doubtful([], [])
    for section in sections:
        _gather(section, None, (), found)
    return found


def _gather(value: object, where: SourceRef | None, around: tuple[Part, ...], found: Doubtful) -> None:
    if isinstance(value, _PARTS):
        _gather_part(value, where, around, found)
    elif isinstance(value, list | tuple):
        for inner in value:
            _gather(inner, where, around, found)
    elif isinstance(value, dict):
        _gather(tuple(value.values()), where, around, found)


def _gather_part(part: Part, where: SourceRef | None, around: tuple[Part, ...], found: Doubtful) -> None:
    kind: type = part.__class__
    names, values_of, extras_of = _ways_into(kind)
    has_extras = any(extras_of(part))
    if not (names or has_extras):
        return
    inside: list[object] = []
    doubtful: list[tuple[str, object]] = []
    for name, value in zip(names, values_of(part), strict=True):
        if isinstance(value, WithExtras):
            inside.append(value)
        elif value:
            if name == RAW_XML or not _is_surely_writable(value):
                doubtful.append((name, value))
            if value.__class__ is not str:
                inside.append(value)
    where = part.source or where
    if doubtful or has_extras:
        held = Held(part, where, around, doubtful)
        found.parts.append(held)
        if has_extras:
            found.with_extras.append(held)
            inside.insert(0, inside_of(part))
    around = (*around, part)
    for inner in inside:
        _gather(inner, where, around, found)


def _is_surely_writable(value: object) -> bool:
    """Whether a field is texts that XML can hold, or parts, which are looked at by themselves; any other may be so."""
    if isinstance(value, str):
        # What Python would print as it stands has none of the characters that XML cannot hold.
        return value.isprintable() or is_writable(value)
    if isinstance(value, LinkPhysics):
        return type(value.self_collide) is type(value.gravity) is bool
    if isinstance(value, tuple):
        return all(map(_is_surely_writable, value))
    return isinstance(value, _WITHOUT_TEXT)


# A union takes three times as long to ask.
_PARTS = (WithExtras, Link, Interface)

_WITHOUT_TEXT = (BasePart, int, float, NoneType)

RAW_XML = "raw_xml"
"""The field of a plugin that is XML, and not text."""

_Values: TypeAlias = Callable[[Part], tuple[object, ...]]


@cache
def _ways_into(kind: type) -> tuple[tuple[str, ...], _Values, _Values]:
    """Return the names of a class's own fields that may hold more than numbers, what gets their values, and extras.

    Half of the parts are of a class without such a field.
    """
    if issubclass(kind, Interface):
        names: tuple[str, ...] = ("parameters",)
    else:
        specs = field_specs(kind).items()
        names = tuple(name for name, spec in specs if spec.xml and not isinstance(spec, Number | Vector))
        names += tuple(name for name in (RAW_XML,) if hasattr(kind, name))
    extras = tuple(name for name in _EXTRAS if hasattr(kind, name))
    return names, _getter(names), _getter(extras)


def _getter(names: tuple[str, ...]) -> _Values:
    return attrgetter(*names) if len(names) > 1 else lambda part: tuple([getattr(part, name) for name in names])


_EXTRAS = ("extra_attributes", "extra_elements", "extra_inside")


def unwritable_texts(parts: Iterable[Held]) -> Iterator[Diagnostic]:
    """Yield an error for each text in parts of a robot that cannot be written as XML."""
    for part, where, _, doubtful in parts:
        if part.extra_attributes or part.extra_elements:
            yield from unwritable_raw(part, where)
        for name, value in doubtful:
            yield from _in_field(part, name, value, where)


def unwritable_raw(part: Extended, where: SourceRef | None) -> Iterator[Diagnostic]:
    """Yield an error for each attribute and raw text of a part that is no XML; the part was written at `where`."""
    for name, value in attribute_pairs(part.extra_attributes) if part.extra_attributes else ():
        place = (*place_of_attribute(name, where), Key(name))
        yield from refused(partial(require_attribute_name, name), *place)
        yield from refused(partial(require_writable, value), *place)
    if part.extra_elements:
        from linkforge_compile.formats.raw import raw_elements

        for text, source, path in raw_texts(part, where):
            yield from refused(partial(raw_elements, text), source, *path)


def _in_field(part: Part, name: str, value: object, where: SourceRef | None) -> Iterator[Diagnostic]:
    if name == RAW_XML and isinstance(value, str):
        from linkforge_compile.formats.raw import raw_elements

        yield from refused(lambda: raw_elements(value), where, name)
    elif isinstance(value, Mapping) and isinstance(part, WithExtras) and field_specs(type(part))[name].xml == "*":
        from linkforge_compile.formats.element import is_surely_writable, parameter_elements

        # A plugin's raw XML stands in place of its parameters.
        for key, text in (
            value.items() if getattr(part, "raw_xml", None) is None and not is_surely_writable(value) else ()
        ):
            yield from refused(partial(parameter_elements, {key: text}), where, name, key)
    else:
        yield from _in_value(value, where, name)


def _in_value(value: object, where: SourceRef | None, *path: str) -> Iterator[Diagnostic]:
    """Look at texts, and those in collections, but not into parts in these."""
    if isinstance(value, str):
        if not is_writable(value):
            yield from refused(partial(require_writable, value), where, *path)
    elif isinstance(value, WithExtras):
        return
    elif isinstance(value, LinkPhysics):
        # No element of its own, and its constructor accepts its booleans as they are.
        for name in ("self_collide", "gravity"):
            yield from _in_value(getattr(value, name), value.source or where, name)
    elif isinstance(value, Mapping):
        for key, inner in value.items():
            yield from _in_value(key, where, *path)
            yield from _in_value(inner, where, *path, key)
    elif isinstance(value, Sequence):
        for inner in value:
            yield from _in_value(inner, where, *path)


def refused(write: Callable[[], object], where: SourceRef | None, *path: str | int) -> Iterator[Diagnostic]:
    """Yield an error where writing is refused."""
    try:
        write()
    except RawXmlError as error:
        yield _malformed(error, where, *path)
    except RobotGeneratorError as error:
        yield UNWRITABLE.at(where, *path, reason=error)


def _malformed(error: RawXmlError, where: SourceRef | None, *path: str | int) -> Diagnostic:
    """Return the error for raw XML: at the place within its text, if the file has that as it is."""
    from linkforge_compile.source.text_place import TextPlace

    fault = UNWRITABLE.at(where, *path, reason=error)
    place = TextPlace.of(error.text, fault.span) if fault.span else None
    if place is None or (span := place.part(error.at, 1)) == fault.span:
        return fault
    begun = () if error.begun is None else (Note("the element that is open begins here", place.part(error.begun, 1)),)
    return replace(UNWRITABLE.at(where, *path, reason=error.problem, notes=begun), span=span)
