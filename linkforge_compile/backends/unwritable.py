"""Finds, with its place, what no XML document can hold, by asking the functions that would write it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import fields, is_dataclass
from functools import cache, partial

from linkforge_compile.backends.element import Extended, attributes, inside_of, raw
from linkforge_compile.backends.markup import escaped
from linkforge_compile.core.exceptions import RobotGeneratorError
from linkforge_compile.core.models.geometry import Vector3
from linkforge_compile.core.models.interface import Interface
from linkforge_compile.core.models.link import Link
from linkforge_compile.core.part import Element
from linkforge_compile.diagnostics import Diagnostic
from linkforge_compile.diagnostics.codes.backends import UNWRITABLE
from linkforge_compile.source import SourceRef

# Nine fields of ten; they hold no text.
_NUMBERS = (float, int, Vector3, type(None))


def unwritable_texts(part: object, where: SourceRef | None = None, *path: str) -> Iterator[Diagnostic]:
    """Yield an error for each text in a part of a robot, at any depth, that cannot be written as XML.

    `where` and `path` are the place of what holds the part.
    """
    if isinstance(part, str):
        yield from refused(lambda: escaped(part), where, *path)
    if isinstance(part, Element | Link | Interface):
        where = part.source or where
        if part.extra_attributes:
            yield from refused(lambda: attributes(part), where, "extra_attributes")
        if part.extra_elements:
            yield from refused(lambda: raw(part), where, "extra")
        yield from unwritable_texts(inside_of(part), where, "extra_inside")
        kind: type = type(part)
        for name in _content(kind):
            if not isinstance(value := getattr(part, name), _NUMBERS):
                yield from _in_field(part, name, value, where)
    elif isinstance(part, Mapping):
        for key, value in part.items():
            yield from unwritable_texts(key, where, *path)
            yield from unwritable_texts(value, where, *path, key)
    elif isinstance(part, Sequence) and not isinstance(part, str):
        for item in part:
            yield from unwritable_texts(item, where, *path)


def _in_field(part: object, name: str, value: object, where: SourceRef | None) -> Iterator[Diagnostic]:
    if name == "raw_xml" and isinstance(value, str):
        from linkforge_compile.backends.raw import raw_elements

        yield from refused(lambda: raw_elements(value), where, name)
    elif isinstance(value, Mapping) and _keys_are_tags(part):
        from linkforge_compile.backends.raw import parameter_elements

        # A plugin's raw XML stands in place of its parameters.
        for key, text in value.items() if getattr(part, "raw_xml", None) is None else ():
            yield from refused(partial(parameter_elements, {key: text}), where, name, key)
    else:
        yield from unwritable_texts(value, where, name)


def _keys_are_tags(part: object) -> bool:
    from linkforge_compile.core.models.gazebo import GazeboElement, GazeboPlugin
    from linkforge_compile.core.models.transmission import Transmission

    return isinstance(part, GazeboElement | GazeboPlugin | Transmission)


def refused(write: Callable[[], object], where: SourceRef | None, *path: str) -> Iterator[Diagnostic]:
    """Yield an error where writing is refused."""
    try:
        write()
    except RobotGeneratorError as error:
        yield UNWRITABLE.at(where, *path, reason=error)


def extended_parts(part: object) -> Iterator[Extended]:
    """Yield all in a part of a robot, at any depth, that has attributes beside its fields', or says what is inside."""
    if isinstance(part, Element | Link | Interface):
        if part.extra_attributes or inside_of(part):
            yield part
        kind: type = type(part)
        for name in _content(kind):
            yield from extended_parts(getattr(part, name))
    elif isinstance(part, Mapping):
        for item in part.values():
            yield from extended_parts(item)
    elif isinstance(part, Sequence) and not isinstance(part, str):
        for item in part:
            yield from extended_parts(item)


@cache
def _content(kind: type) -> tuple[str, ...]:
    """Return the fields of a kind of part, without what every part has."""
    if not is_dataclass(kind):
        return ("parameters",)
    return tuple(field.name for field in fields(kind) if field.name not in _EVERYWHERE)


_EVERYWHERE = frozenset(field.name for field in fields(Element))
