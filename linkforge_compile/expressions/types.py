"""Values that expressions compute with, and the parsed text that holds expressions."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from enum import Enum
from typing import Final, TypeAlias

from linkforge_compile.diagnostics import Code
from linkforge_compile.source import Span
from linkforge_compile.source.text_place import TextPlace
from linkforge_compile.units import Dimension, Quantity, number_text

Value: TypeAlias = None | bool | int | float | str | Quantity | tuple["Value", ...] | Mapping[str, "Value"]
"""The value of a parameter, variable or expression; quantities are in SI units."""


class PathText(str):
    """Text that holds a path relative to the expression's file; `from_compiled` is relative to the compiled file.

    Adding text to it keeps the class, so a name that passes the text on to another name passes on both paths.
    """

    __slots__ = ("from_compiled",)
    from_compiled: str

    def __new__(cls, text: str, from_compiled: str) -> PathText:
        path = super().__new__(cls, text)
        path.from_compiled = from_compiled
        return path


def joined(*texts: str) -> str:
    """Concatenate texts; a PathText if any of them is one."""
    text = "".join(texts)
    has_paths = any(isinstance(part, PathText) for part in texts)
    return PathText(text, "".join(map(seen_from_compiled, texts))) if has_paths else text


def seen_from_compiled(text: str) -> str:
    """Return the text with its paths relative to the compiled file."""
    return text.from_compiled if isinstance(text, PathText) else text


class Fault(Enum):
    """Takes the place of a value that is faulty or unset after the error was reported."""

    FAULT = "fault"


FAULT: Final = Fault.FAULT
"""Operations on it give FAULT again and report nothing."""


class RefusedError(Exception):
    """An operation rejects its operands: `operand` is the index of the wrong one (None: all of them).

    `facts` fill in the message of `code`; `near` are names for a did-you-mean.
    """

    def __init__(self, code: Code, *, operand: int | None = None, near: Iterable[str] = (), **facts: object) -> None:
        self.code = code
        self.operand = operand
        self.near = tuple(near)
        self.facts = facts
        super().__init__(code.id, facts)


def dimension_name(dimension: Dimension | None) -> str:
    """Return "a length", or "a bare number" for None."""
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
    """Return a value as text, a quantity as its SI number; None for null, a list and a map."""
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


@dataclass(frozen=True, eq=False)
class Expression:
    """The text between `$(` and `)`, its place in the scalar, and its syntax tree.

    The tree holds only nodes that the language allows; `names` are its names except functions and constants.
    Columns of the tree count UTF-8 bytes of the text in one pair of parentheses.
    """

    text: str
    offset: int
    place: TextPlace
    tree: ast.expr
    names: tuple[ast.Name, ...] = ()

    def span(self, node: ast.expr) -> Span:
        """Return the span of a part of the expression."""
        start = self.index(node.col_offset)
        end = self.index(node.col_offset if node.end_col_offset is None else node.end_col_offset)
        return self.place.part(self.offset + start, end - start)

    def key_span(self, node: ast.expr) -> Span:
        """Return the span of `key` in `row.key`."""
        whole = self.written(node)
        key = whole.rpartition(".")[2].lstrip()
        return self.place.part(self.offset + self.index(node.col_offset) + len(whole) - len(key), len(key))

    def index(self, column: int) -> int:
        """Return the index into the text for a column of the tree."""
        column = max(column - 1, 0)  # a comprehension begins with the parenthesis that we added
        if self.text.isascii():
            return min(column, len(self.text))
        return len(self.text.encode()[:column].decode(errors="ignore"))

    def written(self, node: ast.expr) -> str:
        """Return the source text of a part of the expression."""
        return self.text[self.index(node.col_offset) : self.index(node.end_col_offset or 0)]


@dataclass(frozen=True, eq=False)
class Template:
    """Text with expressions in it; if the only part is an expression, its value is used as it is."""

    parts: tuple[str | Expression, ...]
    span: Span

    @property
    def names(self) -> frozenset[str]:
        """The parameters, variables and other names that the expressions use."""
        return frozenset(self.names_in_order)

    @property
    def names_in_order(self) -> tuple[str, ...]:
        """The names in the order of their first use."""
        used = (name.id for part in self.parts if isinstance(part, Expression) for name in part.names)
        return tuple(dict.fromkeys(used))
