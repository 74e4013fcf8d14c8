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
from linkforge_compile.diagnostics.enumerations import MOST_LISTED, alternatives, listed
from linkforge_compile.expand.arguments import COMMAND_LINE, Arguments, Variants, typed_file
from linkforge_compile.expand.evaluate import Evaluator, Expressions, report_interpolated_number
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
from linkforge_compile.expand.values import Setting, plain_value
from linkforge_compile.expressions import FAULT, Fault, Value
from linkforge_compile.limits import Limit
from linkforge_compile.load.loader import AnnotatingSink, SpecFile
from linkforge_compile.load.locations import rebased
from linkforge_compile.source import Span
from linkforge_compile.source.provenance import Kind
from linkforge_compile.syntax import YamlFault, YamlList, YamlNode, YamlScalar, has_expression, read, scalar_value

_MAX_SHOWN_TEXT = 60
"""The longest list of choices that a message shows [characters]."""


class _Written(NamedTuple):
    """A value that is written for a parameter: `settings` has what sets it, empty if that is not selected.

    `sink` receives its faults. `evaluator` has the scope of its place, None for plain data, and `folder` is where
    relative paths start there, None for nowhere.
    """

    node: YamlNode
    settings: list[Setting]
    sink: Diagnostics
    evaluator: Evaluator | None
    folder: Path | None


def _value_of(node: YamlNode, type_: ParameterType, evaluator: Evaluator | None) -> Value | Fault:
    """Return the value of a node; a text type keeps a scalar without expressions as written."""
    if type_.is_text and isinstance(node, YamlScalar) and not (evaluator and has_expression(node.text)):
        return node.text
    return evaluator.value(node) if evaluator else plain_value(node)


@dataclass(frozen=True)
class BoundArguments:
    """The arguments of one use of a file.

    `sink` receives faults of the place where they are written. `use` is the `use` that must set required parameters,
    None for the compiled file.
    """

    arguments: Arguments
    sink: Diagnostics
    use: Span | None = None

    def report_unknown(self, declared: dict[str, Declaration], variants: Variants, spec: SpecFile) -> None:
        """Report arguments, and settings of variants, for parameters that the file does not declare."""
        section = spec.tree.entries.get("parameters")
        text = "its parameters are declared here" if section else "this file declares no parameters"
        notes = [Note(text, section.key.span if section else spec.file.whole)]
        settings = ((setting.name, setting) for setting in variants.entries)
        for name, entry in (*self.arguments.entries.items(), *settings):
            if name not in declared:
                self.sink.report(UNKNOWN_PARAMETER.at(entry.key.span, name=name, near=declared, notes=notes))

    def node(self, name: str, type_: ParameterType) -> YamlNode | None:
        """Return the argument for a parameter, None for none; a list, map or vector typed as text is parsed."""
        entry = self.arguments.entries.get(name)
        if entry is None or (isinstance(entry.value, YamlScalar) and entry.value.value is None):
            return None
        node = entry.value
        if not (self.arguments.as_text and type_.is_structured and isinstance(node, YamlScalar)):
            return node
        if type_.name == "vector" and (numbers := _numbers_in(node)):
            return numbers
        file = typed_file(node.span.file.name, f"{name}: {node.text}")
        parsed = read(file, self.sink)
        value = None if parsed is None else parsed.get(name)
        if parsed is None or value is None:
            return YamlFault(node.span) if parsed is None else node
        return value

    def settings(self, name: str, node: YamlNode) -> list[Setting]:
        """Return what set a parameter to the node, then what overrides replaced by it."""
        is_typed = node.span.file.name == COMMAND_LINE
        kind = Kind.WITH if self.use else Kind.COMMAND_LINE if is_typed else Kind.PYTHON
        nodes, entry = [node], self.arguments.entries[name].replaced
        while entry:
            nodes.append(entry.value)
            entry = entry.replaced
        return [Setting(kind, one, self.arguments.evaluator, one.span.file.text if is_typed else "") for one in nodes]


def _numbers_in(node: YamlScalar) -> YamlList | None:
    """Return a list of the numbers in a text with blanks between them, as xacro has them; None for other text."""
    numbers = tuple(YamlScalar(part, scalar_value(part), node.span) for part in node.text.split())
    is_vector = len(numbers) > 1 and all(isinstance(number.value, int | float) for number in numbers)
    return YamlList(numbers, node.span) if is_vector else None


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
    notes = [Note("the parameter is declared here", declaration.key.span)]
    all_written: list[_Written] = []
    if (node := bound.node(declaration.name, type_)) is not None:
        sink, set_by = AnnotatingSink(bound.sink, notes), bound.settings(declaration.name, node)
        all_written.append(_Written(node, set_by, sink, bound.arguments.evaluator, bound.arguments.folder))
    else:
        _report_disagreement(parameter, variants, evaluator)
    for name, node in variants.settings_of(declaration.name):
        sink = AnnotatingSink(evaluator.sink, notes)
        set_by = [Setting(Kind.VARIANT, node, evaluator, name)] if name in variants.selected else []
        all_written.append(_Written(node, set_by, sink, evaluator, spec.part_at(node.span).folder))
    if (node := declaration.default) is not None:
        set_by = [Setting(Kind.PARAMETER_DEFAULT, node, evaluator)]
        all_written.append(_Written(node, set_by, evaluator.sink, evaluator, spec.part_at(node.span).folder))
    value: Value | Fault | None = None
    settings: list[Setting] = []
    for written in all_written:
        is_used = bool(written.settings) and value is None
        # A value without expressions is checked even if it is not used.
        if is_used or not evaluator.expressions.is_computed(written.node):
            found = _fitting_value(parameter, written, spec, evaluator.expressions)
            value = found if is_used else value
        if value is not None:
            settings += written.settings
    if not settings:
        return value, None
    is_normalized = type_.name in ("integer", "boolean")
    return value, replace(settings[0], instead_of=tuple(settings[1:]), is_normalized=is_normalized)


def _fitting_value(
    parameter: Parameter, written: _Written, spec: SpecFile, expressions: Expressions
) -> Value | Fault | None:
    """Return what is written for a parameter as a value of its type; None for null, FAULT after a reported error.

    A path is then relative to the file that declares the parameter.
    """
    node, sink, evaluator = written.node, written.sink, written.evaluator
    value = _value_of(node, parameter.type, evaluator)
    if value is None or value is FAULT:
        return value
    names: Container[str] = evaluator.scope if evaluator else ()
    if not parameter.type.is_text and report_interpolated_number(node, value, expressions, names, sink):
        return FAULT
    if parameter.pattern is not None:
        expressions.budget.spend(Limit.STEPS, parameter.pattern.steps(str(value)), node.span)
    converted = parameter.convert(value, evaluator.place(node) if evaluator else node.span, sink, names)
    if parameter.type.name != "file" or not isinstance(converted, str):
        return FAULT if converted is None else converted
    path = rebased(converted, written.folder, spec)
    if path != converted and Path(path).is_absolute():
        sink.report(FILE_OUTSIDE_PACKAGE.at(node.span, path=converted))
    return path


def _report_disagreement(parameter: Parameter, variants: Variants, evaluator: Evaluator) -> None:
    """Report a parameter that a selected variant sets to another value than the one that decides.

    Computed values are not compared: one that is not used may use names that have no value.
    """
    settings = [setting for setting in variants.settings_of(parameter.name) if setting[0] in variants.selected]
    values = [_constant(parameter.type, node, evaluator) for _, node in settings]
    for (other, node), value in list(zip(settings, values, strict=True))[1:]:
        if None not in (value, values[0]) and value != values[0]:
            (name, used), notes = settings[0], [Note(f"variant '{other}' sets it here", node.span)]
            evaluator.sink.report(
                VARIANTS_DISAGREE.at(used.span, name=parameter.name, by=name, other=other, notes=notes)
            )


def _constant(type_: ParameterType, node: YamlNode, evaluator: Evaluator) -> Value:
    """Return the value of a node as one of the type, None if it is computed or does not fit."""
    value = FAULT if evaluator.expressions.is_computed(node) else _value_of(node, type_, None)
    return None if value is FAULT else type_.convert(value)


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
    value = FAULT if node is None else _value_of(node, unbounded.type, evaluator)
    if node is None or value is FAULT:
        return None
    return unbounded.convert(value, node.span, evaluator.sink, evaluator.scope)


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


_STEPS_PER_INSTRUCTION = 4
"""What compiling one instruction of a pattern costs, in steps of expressions."""


def report_unset(declared: Sequence[Declaration], bound: BoundArguments, variants: Variants) -> None:
    """Report required parameters without a value: together at the `use`, else each where it is declared."""
    if bound.use is not None:
        shown = declared[:MOST_LISTED]
        names = listed([one.name for one in declared], "and")
        what = f"parameter {names} has" if len(declared) == 1 else f"parameters {names} have"
        settings = [*(f"{one.name}: {_placeholder(one)}" for one in shown), *(["…"] if shown != declared else [])]
        remedy = f"'with: {{{', '.join(settings)}}}'"
        notes = [Note(f"'{one.name}' is declared here", one.key.span) for one in shown]
        bound.sink.report(PARAMETER_NOT_SET.at(bound.use, what=what, remedy=remedy, notes=notes))
        return
    in_python = bound.arguments.from_python
    for one in declared:
        itself = f"parameters={{'{one.name}': …}}" if in_python else f"'-p {one.name}={_placeholder(one)}'"
        names_of_variants = [name for name, variant in variants.by_name.items() if variant.get(one.name) is not None]
        selections = [f"variant='{name}'" if in_python else f"'--variant {name}'" for name in names_of_variants]
        remedy = alternatives([itself, *selections[:MOST_LISTED]])
        bound.sink.report(PARAMETER_NOT_SET.at(one.key.span, what=f"parameter '{one.name}' has", remedy=remedy))


def _placeholder(declaration: Declaration) -> str:
    """Return a placeholder for a value: the choices of an `enum`, else the type: "mock|real", "LENGTH"."""
    choices = declaration.constraints.get("enum")
    items = choices.value.items if choices and isinstance(choices.value, YamlList) else ()
    text = "|".join(item.text if isinstance(item, YamlScalar) else "$(" for item in items)
    if 0 < len(text) <= _MAX_SHOWN_TEXT and not has_expression(text):
        return text
    return declaration.type.name.upper() if declaration.type else "VALUE"
