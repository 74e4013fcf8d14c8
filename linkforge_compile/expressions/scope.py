"""Which names an expression may use, and what they are; values are computed when first asked for."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import TypeAlias

from linkforge_compile.diagnostics import Diagnostic, Diagnostics, Note
from linkforge_compile.diagnostics.codes import expressions as codes
from linkforge_compile.expressions.types import FAULT, Fault, Value
from linkforge_compile.limits import Budget
from linkforge_compile.source import Span

MAX_CHAIN = 64
"""How many names may be computed through one another, each for the one before it."""


@dataclass(frozen=True)
class Lazy:
    """A value that is computed when first used: a variable, or a default that names other parameters.

    `compute` reports what it finds at fault and then returns FAULT; `declared` is the span of the name.
    """

    compute: Callable[[], Value | Fault]
    declared: Span


FileFunction: TypeAlias = Callable[[str, Span, Diagnostics], Value | Fault]
"""Computes `path()`, `link()` or `joint()` of a text; the span is where that stands, for what is at fault."""


class Scope:
    """Names and their values; a `for` entry's scope lies inside its file's.

    Lazy values may use one another in any order; a circle of them is reported once, as the path round it.
    """

    def __init__(
        self,
        values: Mapping[str, Value | Fault | Lazy],
        outer: Scope | None = None,
        functions: Mapping[str, FileFunction] | None = None,
        budget: Budget | None = None,
    ) -> None:
        """`functions` are those that only the file around an expression can compute.

        `budget` counts what is computed with these names: that of the outer scope, or a new one, unless given.
        """
        self.budget: Budget = budget or (outer.budget if outer else Budget())
        self._values = dict(values)
        self._outer = outer
        self._functions = functions or {}
        self._open: list[str] = []  # the lazy values being computed, each for the one before it
        self._told_of_a_chain = False

    def inside(self, values: Mapping[str, Value | Fault | Lazy]) -> Scope:
        """Return a scope in which these names are known, too, and hide equal ones of this scope."""
        return Scope(values, self)

    def __contains__(self, name: object) -> bool:
        return name in self._values or (self._outer is not None and name in self._outer)

    def __iter__(self) -> Iterator[str]:
        """Yield every name, the innermost scope's first."""
        yield from self._values
        if self._outer is not None:
            yield from self._outer

    def lookup(self, name: str, sink: Diagnostics) -> Value | Fault:
        """Return the value of a name, FAULT where it has none and that was reported; raise KeyError for no name."""
        if name not in self._values and self._outer is not None:
            return self._outer.lookup(name, sink)
        value = self._values[name]
        return self._compute(name, value, sink) if isinstance(value, Lazy) else value

    def function(self, name: str) -> FileFunction | None:
        """Return what computes a function of the file, None where no file is around."""
        if name in self._functions or self._outer is None:
            return self._functions.get(name)
        return self._outer.function(name)

    def _compute(self, name: str, lazy: Lazy, sink: Diagnostics) -> Value | Fault:
        if name in self._open:
            sink.report(self._circle(name, lazy))
            return FAULT
        if len(self._open) > MAX_CHAIN:
            self._tell_of_a_chain(f"more than {MAX_CHAIN}", sink)
            return FAULT
        self._open.append(name)
        value: Value | Fault = FAULT
        try:
            value = lazy.compute()
        except RecursionError:
            # Names in deep maps and brackets use up the stack before the bound: only the first of them can say so.
            if len(self._open) > 1:
                raise
            self._tell_of_a_chain("too many", sink)
        finally:
            self._open.pop()
            self._values[name] = value
        return value

    def _tell_of_a_chain(self, count: str, sink: Diagnostics) -> None:
        """Report that the first of the open names needs too many others; once, as the rest of them may, too."""
        first = self._values[self._open[0]]
        if isinstance(first, Lazy) and not self._told_of_a_chain:
            sink.report(codes.CHAIN_TOO_LONG.at(first.declared, first=self._open[0], count=count))
        self._told_of_a_chain = True

    def _circle(self, name: str, lazy: Lazy) -> Diagnostic:
        round_trip = self._open[self._open.index(name) :]
        notes = [
            Note(f"'{other}' is computed here", entry.declared)
            for other in round_trip[1:]
            if isinstance(entry := self._values[other], Lazy)
        ]
        path = " → ".join([*round_trip, name])
        return codes.CIRCULAR_NAMES.at(lazy.declared, first=name, path=path, notes=notes)
