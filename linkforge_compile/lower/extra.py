"""`extra`, `extra_attributes` and `extra_inside`: raw XML and raw attributes for what no field says."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING, NotRequired, TypedDict, TypeVar

from linkforge_compile.core.part import Element, Inside
from linkforge_compile.core.raw_xml import RawXml
from linkforge_compile.source import SourceRef

if TYPE_CHECKING:
    from linkforge_compile.lower.fields import Fields


E = TypeVar("E", bound=Element)

EXTRA_KEYS = frozenset({"extra", "extra_attributes", "extra_inside"})


class Besides(TypedDict):
    """What the constructor of every element takes besides its own fields: where it was written, and what is said raw.

    Nearly all say nothing raw, and a constructor that is told less is quicker.
    """

    source: SourceRef
    extra_elements: NotRequired[tuple[str, ...]]
    extra_attributes: NotRequired[tuple[tuple[str, str], ...]]
    extra_inside: NotRequired[tuple[Inside, ...]]


class OuterExtras(TypedDict):
    """What is said raw of a link and of a robot, which hold nothing but parts."""

    extra_elements: tuple[str, ...]
    extra_attributes: tuple[tuple[str, str], ...]


_NO_OUTER_EXTRAS = OuterExtras(extra_elements=(), extra_attributes=())


def besides(fields: Fields) -> Besides:
    """Read what an object says raw. Whether it is XML, the backend judges, who knows how it would be written."""
    if EXTRA_KEYS.isdisjoint(fields.node.entries):
        return {"source": fields.ref}
    return {"source": fields.ref, **outer_extras_of(fields), "extra_inside": tuple(_insides(fields))}


def with_extras(part: E, fields: Fields) -> E:
    """Return a part with what its object says raw; for the many that say nothing, quicker than `besides`."""
    if EXTRA_KEYS.isdisjoint(fields.node.entries):
        return part
    return replace(part, **besides(fields))


def outer_extras_of(fields: Fields) -> OuterExtras:
    """Read what a link or a robot says raw."""
    if EXTRA_KEYS.isdisjoint(fields.node.entries):
        return _NO_OUTER_EXTRAS
    from linkforge_compile.lower.free_part import texts_in

    section = fields.map("extra_attributes")
    attributes = tuple((RawXml(name, section.ref), text) for name, text in texts_in(section).items()) if section else ()
    texts = ((fields.text_at(node, "extra"), SourceRef(node, None, fields.trail)) for node in fields.items("extra"))
    return OuterExtras(
        extra_elements=tuple(RawXml(text, source) for text, source in texts if text and text.strip()),
        extra_attributes=attributes,
    )


def _insides(fields: Fields) -> Iterator[Inside]:
    """Lower what is said of elements inside, by tag, or by tag and name with a space between them."""
    for key, inside in fields.each("extra_inside", "element", lambda inside, _: inside):
        tag, _, name = key.partition(" ")
        if inside:
            yield Inside(tag, name.strip() or None, **besides(inside))
