"""What expressions compute with: values, the fault that stands for a value, and why a value cannot be had."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from enum import Enum
from typing import Final, TypeAlias

from linkforge_compile.diagnostics import Code
from linkforge_compile.units import Dimension, Quantity, number_text

Value: TypeAlias = None | bool | int | float | str | Quantity | tuple["Value", ...] | Mapping[str, "Value"]
"""What a parameter, a variable or an expression may be; quantities are in SI units."""


class PathText(str):
    """Text with a path in it that is relative to the file of the expression; `from_compiled` is the compiled file's.

    It stays one where more text is put to it, so a name may be made of it that only another name hands to its reader.
    """

    __slots__ = ("from_compiled",)
    from_compiled: str

    def __new__(cls, text: str, from_compiled: str) -> PathText:
        path = super().__new__(cls, text)
        path.from_compiled = from_compiled
        return path


def joined(*texts: str) -> str:
    """Return texts put together, with the paths in them."""
    text = "".join(texts)
    has_paths = any(isinstance(part, PathText) for part in texts)
    return PathText(text, "".join(map(seen_from_compiled, texts))) if has_paths else text


def seen_from_compiled(text: str) -> str:
    """Return text with the paths in it as the compiled file would write them."""
    return text.from_compiled if isinstance(text, PathText) else text


class Fault(Enum):
    """Stands where a value would, but that is faulty or unset, and this was reported where it belongs."""

    FAULT = "fault"


FAULT: Final = Fault.FAULT
"""Who meets it gives it on and stays silent."""


class RefusedError(Exception):
    """An operation refuses its operands: which one is to blame (None: all), and the facts of the code's sentence."""

    def __init__(self, code: Code, *, operand: int | None = None, near: Iterable[str] = (), **facts: object) -> None:
        self.code = code
        self.operand = operand
        self.near = tuple(near)
        self.facts = facts
        super().__init__(code.id, facts)


def dimension_name(dimension: Dimension | None) -> str:
    """Return "a length", or "a bare number" for none."""
    if dimension is None:
        return "a bare number"
    name = dimension.replace("_", " ")
    return f"{'an' if name[0] in 'aeiou' else 'a'} {name}"


def kind_name(value: Value) -> str:
    """Return what messages call a value of this kind."""
    match value:
        case None:
            return "null"
        case bool():
            return "true" if value else "false"
        case int() | float():
            return "a number"
        case Quantity():
            return dimension_name(value.dimension)
        case str():
            return f"the text '{value}'" if len(value) <= 20 else "text"
        case tuple():
            return "a list"
    return "a map"


def as_text(value: Value) -> str | None:
    """Return a value as it stands inside text, a quantity as its SI number; None for null, a list and a map."""
    match value:
        case bool():
            return "true" if value else "false"
        case int() | float():
            return number_text(value)
        case Quantity():
            return number_text(value.value)
        case str():
            return value
    return None
