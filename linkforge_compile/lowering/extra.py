"""`extra` and `extra_attributes`: raw XML and raw attributes for what no field says."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypedDict

if TYPE_CHECKING:
    from linkforge_compile.lowering.fields import Fields


EXTRA_KEYS = ("extra", "extra_attributes")


class Extras(TypedDict):
    """What the constructor of every element takes besides its own fields."""

    extra_elements: tuple[str, ...]
    extra_attributes: tuple[tuple[str, str], ...]


NO_EXTRAS = Extras(extra_elements=(), extra_attributes=())
"""Of what is written in a short form, which has no place for them."""


def extras_of(fields: Fields) -> Extras:
    """Read what an object says raw. Whether it is XML, the backend judges, who knows how it would be written."""
    entries = fields.node.entries
    if "extra" not in entries and "extra_attributes" not in entries:
        return NO_EXTRAS
    from linkforge_compile.lowering.free_part import free_texts

    texts = (fields.text_at(node, "extra") for node in fields.items("extra"))
    return Extras(
        extra_elements=tuple(text for text in texts if text and text.strip()),
        extra_attributes=tuple(free_texts(fields, "extra_attributes").items()),
    )
