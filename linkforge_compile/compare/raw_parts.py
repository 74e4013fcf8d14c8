"""Raw XML as parts, so that a change in it is told at the tag and attribute where it is, whatever its layout."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping
from dataclasses import field
from decimal import Decimal

from linkforge_compile.backends.raw import Node, inline, is_text, nodes_of
from linkforge_compile.core.exceptions import RobotGeneratorError
from linkforge_compile.frozen import dataclass


@dataclass(frozen=True, slots=True)
class RawElement:
    """An element of raw XML: `text` is what stands in it beside elements and comments, `written` the whole of it."""

    tag: str
    attributes: Mapping[str, str]
    text: str
    inside: tuple[RawElement, ...]
    written: str = field(compare=False)

    @property
    def name(self) -> str | None:
        """Its attribute of that name."""
        return self.attributes.get("name")


def raw_parts(texts: Iterable[str]) -> tuple[RawElement | str, ...]:
    """Return the elements of texts of raw XML; one that is not well-formed, as only Python makes it, as it stands."""
    return tuple(part for text in texts for part in _parts(text))


def _parts(text: str) -> tuple[RawElement | str, ...]:
    try:
        return tuple(map(_element, nodes_of(text)))
    except RobotGeneratorError:
        return (text,)


def _element(node: Node) -> RawElement:
    inside = tuple(_element(item) for item in node.content if isinstance(item, Node))
    text = "".join(str(item) for item in node.content if is_text(item)).strip()
    return RawElement(node.tag, dict(node.attributes), text, inside, str(inline(node)))


_WHOLE = r"[+-]?(?:0|[1-9]\d*)"
_NUMBER = re.compile(rf"{_WHOLE}(?:\.\d*)?(?:[eE][+-]?\d{{1,3}})?|[+-]?\.\d+(?:[eE][+-]?\d{{1,3}})?")
"""A number as XML has it. One that begins with a zero is not meant as one: 007 is another name than 7."""


def say_the_same(before: str, after: str) -> bool:
    """Whether two texts in XML are the same numbers: `0.20 1e-3` is another spelling of `0.2 0.001`."""
    were, are = before.split(), after.split()
    return len(were) == len(are) > 0 and all(map(_is_same_number, were, are))


def number_in(text: str) -> float | None:
    """Return the number that a text in XML is; None for another text, and for one that no double holds."""
    number = float(text) if _NUMBER.fullmatch(text.strip()) else math.inf
    return number if math.isfinite(number) else None


def _is_same_number(before: str, after: str) -> bool:
    if not (_NUMBER.fullmatch(before) and _NUMBER.fullmatch(after)):
        return False
    if re.fullmatch(_WHOLE, before) or re.fullmatch(_WHOLE, after):
        # The number of something may have more digits than a double.
        return Decimal(before) == Decimal(after)
    return float(before) == float(after)
