"""Decide the value of each parameter: the argument, else the selected variant's setting, else the default."""

from __future__ import annotations

from collections.abc import Container, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import NamedTuple

from linkforge_compile.diagnostics import Diagnostics, Note
from linkforge_compile.diagnostics.codes.modules import (
    BAD_PATTERN,
    CROSSED_BOUNDS,
    FILE_OUTSIDE_PACKAGE,
    NO_CHOICE,
    PARAMETER_NOT_SET,
    UNFIT_CONSTRAINT,
    UNKNOWN_PARAMETER,
    VARIANTS_DISAGREE,
)
from linkforge_compile.expand.arguments import COMMAND_LINE, Arguments, Variants
from linkforge_compile.expand.evaluate import Evaluator, Expressions, report_interpolated_number
from linkforge_compile.expand.loader import AnnotatingSink, SpecFile
from linkforge_compile.expand.parameters import (
    PARAMETER_TYPES,
    REFUSED_STEPS,
    Declaration,
    Parameter,
    ParameterType,
    Pattern,
    PatternError,
    number_of,
    resolve_type,
    unquoted,
)
from linkforge_compile.expand.uses import rebased
from linkforge_compile.expand.values import Setting, plain_value
from linkforge_compile.expressions import FAULT, Fault, Value
from linkforge_compile.limits import Limit
from linkforge_compile.schema.shapes import alternatives
from linkforge_compile.source import SourceFile, Span
from linkforge_compile.syntax import YamlFault, YamlList, YamlMap, YamlNode, YamlScalar, has_expression, read

_MAX_SHOWN = 8
"""How many parameters, choices and variants a message shows."""

_MAX_SHOWN_TEXT = 60
"""The longest list of choices that a message shows [characters]."""


@dataclass(frozen=True)
class BoundArguments:
    """The arguments of one use of a file.

    `sink` receives faults of the place where they are written, and `evaluator` has the scope of that place, None if
    they hold no expressions. `use` is the `use` that must set required parameters, None for the compiled file.
    """

    arguments: Arguments
    sink: Diagnostics
    evaluator: Evaluator | None = None
    use: Span | None = None

    def report_unknown(self, declared: dict[str, Declaration], variants: Variants, spec: SpecFile) -> None:
        """Report arguments, and settings of variants, for parameters that the file does not declare."""
        section = spec.tree.entries.get("parameters")
        text = "its parameters are declared here" if section else "this file declares no parameters"
        notes = [Note(text, section.key.span if section else spec.file.whole)]
        for name, entry in (
            *self.arguments.entries.items(),
            *((setting.name, setting) for setting in variants.entries()),
        ):
            if name not in declared:
                self.sink.report(UNKNOWN_PARAMETER.at(entry.key.span, name=name, near=declared, notes=notes))

    def node(self, name: str, type_: ParameterType) -> YamlNode | None:
        """Return the argument for a parameter, None for none; a list or map typed as text is parsed."""
        entry = self.arguments.entries.get(name)
        if entry is None or (isinstance(entry.value, YamlScalar) and entry.value.value is None):
            return None
        node = entry.value
        if not (self.arguments.as_text and type_.is_structured and isinstance(node, YamlScalar)):
            return node
        file = SourceFile(node.span.file.name, f"{name}: {node.text}")
        parsed = read(file, self.sink)
        return YamlFault(node.span) if parsed is None else parsed.get(name) or node

    def value(self, node: YamlNode, type_: ParameterType) -> Value | Fault:
        """Return the value of an argument for a parameter of a type."""
        if self.evaluator:
            return evaluate_for(type_, node, self.evaluator)
        return node.text if type_.is_text and isinstance(node, YamlScalar) else plain_value(node)

    def place(self, node: YamlNode) -> Span:
        return self.evaluator.place(node) if self.evaluator else node.span

    @property
    def names(self) -> Container[str]:
        """The names that expressions may use where the arguments are written."""
        return self.evaluator.scope if self.evaluator else ()

    def settings(self, name: str, node: YamlNode) -> list[Setting]:
        """Return what set a parameter to the node, then what overrides replaced by it."""
        by = "'with'" if self.use else "the command line" if node.span.file.name == COMMAND_LINE else "Python"
        settings, entry = [Setting(by, node, self.evaluator)], self.arguments.entries[name].replaced
        while entry:
            settings.append(Setting(by, entry.value, self.evaluator))
            entry = entry.replaced
        return settings


def parameter_value(
    declaration: Declaration, bound: BoundArguments, variants: Variants, spec: SpecFile, evaluator: Evaluator
) -> tuple[Value | Fault | None, Setting | None]:
    """Return the value of a parameter and what set it; None for no value, FAULT after a reported error.

    `evaluator` has the scope of `spec`, which declares it.
    """
    type_ = resolve_type(declaration, evaluator)
    if type_ is None:
        return FAULT, None
    parameter = make_parameter(declaration, type_, evaluator)
    result, settings = _argument_value(parameter, bound, spec, evaluator, declaration.key.span)
    noted = _declared_here(evaluator.sink, declaration.key.span)
    selected = variants.values_of(declaration.name)
    if result is None:
        _report_other_settings(declaration.name, selected, evaluator.sink)
    for node, sink, by in (
        *((value, noted, f"variant '{name}'") for name, value in selected),
        *((other, noted, "") for other in variants.other_values_of(declaration.name)),
        (declaration.default, evaluator.sink, "the default"),
    ):
        is_used = bool(by) and result is None
        # A value without expressions is checked even if it is not used.
        if node is not None and (is_used or not _has_expressions(node)):
            value = _own_value(parameter, node, spec, evaluator, sink)
            result = value if is_used else result
        if node is not None and by and result is not None:
            settings.append(Setting(by, node, evaluator))
    return result, replace(settings[0], instead_of=tuple(settings[1:])) if settings else None


def _report_other_settings(parameter: str, selected: Sequence[tuple[str, YamlNode]], sink: Diagnostics) -> None:
    """Report a parameter that a selected variant sets to another value than the one that decides, which is first."""
    for name, node in selected[1:]:
        by, used = selected[0]
        if plain_value(node) != plain_value(used):
            notes = [Note(f"variant '{name}' sets it here", node.span)]
            sink.report(VARIANTS_DISAGREE.at(used.span, name=parameter, by=by, other=name, notes=notes))


def make_parameter(declaration: Declaration, type_: ParameterType, evaluator: Evaluator) -> Parameter:
    """Compute the constraints of a declaration; faulty ones are reported and left out."""
    constraints: dict[str, YamlNode] = {}
    for name, entry in declaration.constraints.items():
        if name in type_.constraints:
            constraints[name] = entry.value
        else:
            evaluator.sink.report(UNFIT_CONSTRAINT.at(entry.key.span, constraint=name, type=type_.name))
    bounds = Parameter(declaration.name, PARAMETER_TYPES["number"] if type_.name == "integer" else type_)
    minimum, maximum = (_constraint(bounds, constraints.get(name), evaluator) for name in ("minimum", "maximum"))
    if minimum is not None and maximum is not None and number_of(minimum) > number_of(maximum):
        where, least, most = constraints["minimum"].span, unquoted(minimum), unquoted(maximum)
        evaluator.sink.report(CROSSED_BOUNDS.at(where, parameter=declaration.name, minimum=least, maximum=most))
        minimum = maximum = None
    return Parameter(
        declaration.name,
        type_,
        minimum,
        maximum,
        choices=_choices(Parameter(declaration.name, type_), constraints.get("enum"), evaluator),
        pattern=_pattern(constraints.get("pattern"), evaluator),
    )


def _constraint(unbounded: Parameter, node: YamlNode | None, evaluator: Evaluator) -> Value:
    value = FAULT if node is None else evaluate_for(unbounded.type, node, evaluator)
    return (
        None if node is None or value is FAULT else unbounded.convert(value, node.span, evaluator.sink, evaluator.scope)
    )


def _choices(unbounded: Parameter, node: YamlNode | None, evaluator: Evaluator) -> tuple[Value, ...] | None:
    if not isinstance(node, YamlList):
        return None
    if not node.items:
        evaluator.sink.report(NO_CHOICE.at(node.span, parameter=unbounded.name))
        return None
    choices = [_constraint(unbounded, item, evaluator) for item in node]
    return None if None in choices else tuple(choices)


def _pattern(node: YamlNode | None, evaluator: Evaluator) -> Pattern | None:
    if not isinstance(node, YamlScalar):
        return None
    budget = evaluator.expressions.budget
    try:
        pattern = Pattern(node.text)
        budget.spend(Limit.STEPS, pattern.steps("") * _STEPS_PER_INSTRUCTION, node.span)
        return pattern
    except PatternError as error:
        budget.spend(Limit.STEPS, REFUSED_STEPS, node.span)
        evaluator.sink.report(BAD_PATTERN.at(node.span, pattern=node.text, reason=error))
        return None


def evaluate_for(type_: ParameterType, node: YamlNode, evaluator: Evaluator) -> Value | Fault:
    """Return the value of a node for a parameter of a type; a text type keeps a plain scalar as written."""
    if type_.is_text and isinstance(node, YamlScalar) and not has_expression(node.text):
        return node.text
    return evaluator.value(node)


_STEPS_PER_INSTRUCTION = 4
"""What compiling one instruction of a pattern costs, in steps of expressions."""


def _has_expressions(node: YamlNode) -> bool:
    if isinstance(node, YamlScalar):
        return has_expression(node.text)
    if isinstance(node, YamlMap):
        return any(has_expression(entry.name) or _has_expressions(entry.value) for entry in node)
    return isinstance(node, YamlList) and any(map(_has_expressions, node))


def _declared_here(sink: Diagnostics, declared: Span) -> Diagnostics:
    return AnnotatingSink(sink, [Note("the parameter is declared here", declared)])


def _argument_value(
    parameter: Parameter, bound: BoundArguments, spec: SpecFile, evaluator: Evaluator, declared: Span
) -> tuple[Value | Fault | None, list[Setting]]:
    """Return the value of the argument, None for none, and what set it."""
    node = bound.node(parameter.name, parameter.type)
    value = None if node is None else bound.value(node, parameter.type)
    if node is None or value is None:
        return None, []
    sink = _declared_here(bound.sink, declared)
    written = _Written(node, value, bound.place(node), bound.names)
    converted = _convert(parameter, written, evaluator.expressions, sink)
    path = _rebase_file(parameter, converted, bound.arguments.folder, spec)
    if isinstance(converted, str) and path != converted and Path(str(path)).is_absolute():
        sink.report(FILE_OUTSIDE_PACKAGE.at(node.span, path=converted))
    return path, bound.settings(parameter.name, node)


def _own_value(
    parameter: Parameter, node: YamlNode, spec: SpecFile, evaluator: Evaluator, sink: Diagnostics
) -> Value | Fault | None:
    """Return the value of a default, or of a variant's setting; None for none."""
    value = evaluate_for(parameter.type, node, evaluator)
    if value is None:
        return None
    written = _Written(node, value, evaluator.place(node), evaluator.scope)
    converted = _convert(parameter, written, evaluator.expressions, sink)
    return _rebase_file(parameter, converted, spec.part_at(node.span).folder, spec)


class _Written(NamedTuple):
    """A node written for a parameter, its value, the place to report it at, and the names known there."""

    node: YamlNode
    value: Value | Fault
    place: Span
    names: Container[str]


def _convert(parameter: Parameter, written: _Written, expressions: Expressions, sink: Diagnostics) -> Value | Fault:
    """Return the value as one of the parameter's type, FAULT if it does not fit, which is reported at its place."""
    node, value, place, names = written
    if value is FAULT:
        return FAULT
    if not parameter.type.is_text and report_interpolated_number(node, value, expressions, names, sink):
        return FAULT
    if parameter.pattern is not None:
        expressions.budget.spend(Limit.STEPS, parameter.pattern.steps(str(value)), node.span)
    converted = parameter.convert(value, place, sink, names)
    return FAULT if converted is None else converted


def _rebase_file(parameter: Parameter, value: Value | Fault, writer: Path | None, spec: SpecFile) -> Value | Fault:
    """Return a path written in the folder `writer` relative to the file that declares the parameter."""
    return rebased(value, writer, spec) if parameter.type.name == "file" and isinstance(value, str) else value


def report_unset(declared: Sequence[Declaration], bound: BoundArguments, variants: Variants) -> None:
    """Report required parameters without a value: together at the `use`, else each where it is declared."""
    if bound.use is not None:
        rest = len(declared) - _MAX_SHOWN
        names = [*(f"'{one.name}'" for one in declared[:_MAX_SHOWN]), *([f"{rest} more"] if rest > 0 else [])]
        settings = [
            *(f"{one.name}: {_placeholder(one)}" for one in declared[:_MAX_SHOWN]),
            *(["…"] if rest > 0 else []),
        ]
        what = f"parameter {names[0]} has" if len(names) == 1 else f"parameters {alternatives(names, 'and')} have"
        notes = [Note(f"'{one.name}' is declared here", one.key.span) for one in declared[:_MAX_SHOWN]]
        remedy = f"'with: {{{', '.join(settings)}}}'"
        bound.sink.report(PARAMETER_NOT_SET.at(bound.use, what=what, remedy=remedy, notes=notes))
        return
    in_python = bound.arguments.from_python
    for one in declared:
        itself = f"parameters={{'{one.name}': …}}" if in_python else f"'-p {one.name}={_placeholder(one)}'"
        names = [name for name, variant in variants.by_name.items() if variant.get(one.name) is not None][:_MAX_SHOWN]
        remedy = alternatives(
            [itself, *(f"variant='{name}'" if in_python else f"'--variant {name}'" for name in names)]
        )
        bound.sink.report(PARAMETER_NOT_SET.at(one.key.span, what=f"parameter '{one.name}' has", remedy=remedy))


def _placeholder(declaration: Declaration) -> str:
    """Return a placeholder for a value: the choices of an `enum`, else the type: "mock|real", "LENGTH"."""
    choices = declaration.constraints.get("enum")
    items = choices.value.items if choices and isinstance(choices.value, YamlList) else ()
    words = [item.text for item in items if isinstance(item, YamlScalar) and not has_expression(item.text)]
    text = "|".join(words[:_MAX_SHOWN])
    if 0 < len(words) == len(items) <= _MAX_SHOWN and len(text) <= _MAX_SHOWN_TEXT:
        return text
    return declaration.type.name.upper() if declaration.type else "VALUE"
