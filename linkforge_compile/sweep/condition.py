"""The option `--where`: an expression of the language that decides which points are compiled."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path

from linkforge_compile.analysis import Settings
from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.expand.arguments import Unset
from linkforge_compile.expand.evaluate import Expressions
from linkforge_compile.expand.file_scope import CompileState, FileScope, Use
from linkforge_compile.expand.parameter_values import BoundArguments
from linkforge_compile.expand.parameters import Parameter
from linkforge_compile.expressions import FAULT, Scope, evaluate, kind_name, parse_template
from linkforge_compile.limits import Budget
from linkforge_compile.load import Loader, SpecFile, is_xacro
from linkforge_compile.source import SourceFile, Span
from linkforge_compile.sweep.declared import value_of
from linkforge_compile.sweep.errors import SweepError
from linkforge_compile.sweep.points import Point
from linkforge_compile.sweep.wording import Wording

SettingsOf = Callable[[Point], Settings]
"""Returns the settings with which the robot of a point is compiled."""


class Condition:
    """Tells which points hold, with the parameters and variables of the spec in scope."""

    def __init__(
        self, text: str, spec: Path, settings_of: SettingsOf, parameters: Mapping[str, Parameter], words: Wording
    ) -> None:
        """Parse the expression; without `$(` the whole text is one. SweepError with its faults."""
        source, before = words.source("where")
        shown, start = f"{before}{text}" if "$(" in text else f"{before}$({text})", len(before)
        self._file, self._option = SourceFile(source, shown), words.option("where")
        span = Span(self._file, 1, start + 1, 1, len(shown) + 1)
        sink = Diagnostics()
        template = parse_template(shown[start:], span, sink)
        if template is None:
            raise SweepError(f"{self._option} cannot be read", sink.sorted())
        if len(template.parts) != 1 or isinstance(template.parts[0], str):
            raise SweepError(f"{self._option} takes one expression, such as '$(reach > 2 * base)', found '{text}'")
        self._template, self._settings_of, self._parameters = template, settings_of, parameters
        self._loader: Loader | None = None
        self._spec: SpecFile | None = None
        if not is_xacro(spec):
            self._loader = settings_of(Point(0, {})).loader(spec)
            self._spec = self._loader.open(spec, Diagnostics())

    def holds(self, point: Point) -> bool:
        """Whether the expression is true at a point.

        A point whose parameters are faulty holds: its compile reports them. SweepError for a fault of the expression.
        """
        sink = Diagnostics()
        value = evaluate(self._template, self._scope(point, sink), sink)
        faults = tuple(one for one in sink.sorted() if one.span and one.span.file is self._file)
        if faults:
            raise SweepError(f"{self._option} fails at point {point.index} ({' '.join(point.words)})", faults)
        if value is FAULT:
            return True
        if not isinstance(value, bool):
            raise SweepError(f"{self._option} takes an expression that is true or false, found {kind_name(value)}")
        return value

    def _scope(self, point: Point, sink: Diagnostics) -> Scope:
        if self._spec is None or self._loader is None:
            spans = Span(self._file, 1, 1, 1, 1)
            values = {name: value_of(text, spans, self._parameters[name], sink) for name, text in point.values.items()}
            return Scope(values)
        settings, loader = self._settings_of(point), self._loader
        loader.budget = Budget()
        arguments = settings.arguments(loader, sink)
        state = CompileState(self._spec, loader, Expressions(loader.budget), Unset.NOTE, settings.variant)
        return FileScope(Use(self._spec, BoundArguments(arguments, sink)), state, sink).evaluator.scope
