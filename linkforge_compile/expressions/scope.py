"""The names that expressions may use; values are computed on first use."""

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
