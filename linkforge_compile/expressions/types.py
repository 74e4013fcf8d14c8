"""Values that expressions compute with, the names that have them, and the parsed text."""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from enum import Enum
from typing import Final, TypeAlias

from linkforge_compile.diagnostics import Code, Diagnostic, Diagnostics, Note
from linkforge_compile.diagnostics.codes import expressions as codes
from linkforge_compile.limits import Budget
from linkforge_compile.source import Span
from linkforge_compile.source.text_place import TextPlace
from linkforge_compile.units import Dimension, Quantity, number_text

Value: TypeAlias = None | bool | int | float | str | Quantity | tuple["Value", ...] | Mapping[str, "Value"]
"""The value of a parameter, variable or expression; quantities are in SI units."""


ValuePath: TypeAlias = tuple[str | int, ...]
"""The keys and positions that lead to a part of a value."""


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
    return dimension.words if dimension else "a bare number"


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


MAX_CHAIN = 64
"""How many names may be computed at once, each because the one before it uses it."""


@dataclass(frozen=True)
class Lazy:
    """A value that is computed on first use: a variable, or a default that uses other parameters.

    `compute` reports errors and then returns FAULT; `declared` is the span of the name.
    """

    compute: Callable[[], Value | Fault]
    declared: Span


FileFunction: TypeAlias = Callable[[str, Span, Diagnostics], Value | Fault]
"""Computes `path()`, `link()` or `joint()` of a text; errors are reported at the span."""


class Scope:
    """Names and their values; the scope of a `for` entry is inside that of its file.

    Lazy values may use one another in any order; a cycle of them is reported once, with its path.
    """

    def __init__(
        self,
        values: Mapping[str, Value | Fault | Lazy],
        outer: Scope | None = None,
        functions: Mapping[str, FileFunction] | None = None,
        budget: Budget | None = None,
    ) -> None:
        """`functions` depend on the file around an expression; `budget` is by default that of the outer scope."""
        self.budget: Budget = budget or (outer.budget if outer else Budget())
        self._values = dict(values)
        self._outer = outer
        self._functions = functions or {}
        self._open: list[str] = []  # the lazy values being computed, each because the one before it uses it
        self._is_chain_reported = False

    def inside(self, values: Mapping[str, Value | Fault | Lazy]) -> Scope:
        """Return an inner scope with these names, which hide equal names of this scope."""
        return Scope(values, self)

    @property
    def own_values(self) -> tuple[Value | Fault | Lazy, ...]:
        """The values of the innermost names."""
        return tuple(self._values.values())

    def __contains__(self, name: object) -> bool:
        return name in self._values or (self._outer is not None and name in self._outer)

    def __iter__(self) -> Iterator[str]:
        """Yield every name, the innermost scope's first."""
        yield from self._values
        if self._outer is not None:
            yield from self._outer

    def lookup(self, name: str, sink: Diagnostics) -> Value | Fault:
        """Return the value of a name, FAULT after a reported error; raise KeyError for an unknown name."""
        if name not in self._values and self._outer is not None:
            return self._outer.lookup(name, sink)
        value = self._values[name]
        return self._compute(name, value, sink) if isinstance(value, Lazy) else value

    def function(self, name: str) -> FileFunction | None:
        """Return a function that depends on the file, None outside of a file."""
        if name in self._functions or self._outer is None:
            return self._functions.get(name)
        return self._outer.function(name)

    def _compute(self, name: str, lazy: Lazy, sink: Diagnostics) -> Value | Fault:
        if name in self._open:
            sink.report(self._cycle(name, lazy))
            return FAULT
        if len(self._open) > MAX_CHAIN:
            self._report_chain(f"more than {MAX_CHAIN}", sink)
            return FAULT
        self._open.append(name)
        value: Value | Fault = FAULT
        try:
            value = lazy.compute()
        except RecursionError:
            # Names in deep maps and brackets use up the stack before MAX_CHAIN; only the first of them reports it.
            if len(self._open) > 1:
                raise
            self._report_chain("too many", sink)
        finally:
            self._open.pop()
            self._values[name] = value
        return value

    def _report_chain(self, count: str, sink: Diagnostics) -> None:
        """Report that the first of the open names needs too many others; once, although the others may as well."""
        first = self._values[self._open[0]]
        if isinstance(first, Lazy) and not self._is_chain_reported:
            sink.report(codes.CHAIN_TOO_LONG.at(first.declared, first=self._open[0], count=count))
        self._is_chain_reported = True

    def _cycle(self, name: str, lazy: Lazy) -> Diagnostic:
        round_trip = self._open[self._open.index(name) :]
        notes = [
            Note(f"'{other}' is computed here", entry.declared)
            for other in round_trip[1:]
            if isinstance(entry := self._values[other], Lazy)
        ]
        path = " → ".join([*round_trip, name])
        return codes.CIRCULAR_NAMES.at(lazy.declared, first=name, path=path, notes=notes)
