"""Finds, with its place, what no XML document can hold, by asking the functions that would write it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial

from linkforge_compile.core.exceptions import RobotGeneratorError
from linkforge_compile.core.fields import field_specs
from linkforge_compile.core.models.link import LinkPhysics
from linkforge_compile.core.part import WithExtras, attribute_pairs
from linkforge_compile.diagnostics import Diagnostic, Note
from linkforge_compile.diagnostics.codes.formats import UNWRITABLE
from linkforge_compile.formats.element import (
    Extended,
    place_of_attribute,
    raw_texts,
    require_attribute_name,
)
from linkforge_compile.formats.parts import RAW_XML, Held, Part
from linkforge_compile.formats.xml_text import RawXmlError, is_writable, require_writable
from linkforge_compile.source import Key, SourceRef


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
