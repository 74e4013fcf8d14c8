"""Read the declarations of `parameters`, and check values against their types and constraints."""

from __future__ import annotations

from collections.abc import Container, Iterator, Mapping
from dataclasses import dataclass, field

from linkforge_compile.diagnostics import Diagnostic, Diagnostics
from linkforge_compile.diagnostics.codes.model import WIDE_ANGLE
from linkforge_compile.diagnostics.codes.modules import (
    BAD_PATTERN,
    CROSSED_BOUNDS,
    NO_CHOICE,
    PARAMETER_CHOICE,
    PARAMETER_KIND,
    PARAMETER_PATTERN,
    PARAMETER_TOO_LARGE,
    PARAMETER_TOO_SMALL,
    PARAMETER_WITHOUT_TYPE,
    UNFIT_CONSTRAINT,
)
from linkforge_compile.expand.evaluate import Evaluator
from linkforge_compile.expand.parameter_types import (
    PARAMETER_TYPES,
    REFUSED_STEPS,
    ParameterType,
    Pattern,
    PatternError,
    infer_type,
)
from linkforge_compile.expand.values import describe
from linkforge_compile.expressions import FAULT, Fault, Value, forgotten_expression
from linkforge_compile.limits import Limit
from linkforge_compile.source import Span
from linkforge_compile.syntax import YamlEntry, YamlFault, YamlList, YamlMap, YamlNode, YamlScalar, has_expression
from linkforge_compile.syntax.nodes import YAML_1_1_BOOLEANS
from linkforge_compile.units import WIDEST_ANGLE, Dimension, Quantity, number_text, unit_text

_STEPS_PER_INSTRUCTION = 4
"""What compiling one instruction of a pattern costs, in steps of expressions."""

_CONSTRAINTS = ("minimum", "maximum", "enum", "pattern")


@dataclass(frozen=True)
class Declaration:
    """A parameter as declared; `type` is None if it follows from the default.

    `is_faulty` if a part that decides on valid values was reported: then neither a value nor a missing one is.
    """

    key: YamlScalar
    type: ParameterType | None = None
    default: YamlNode | None = None
    constraints: Mapping[str, YamlEntry] = field(default_factory=dict)
    is_faulty: bool = False

    @property
    def name(self) -> str:
        return self.key.text


def declarations(section: YamlNode | None) -> dict[str, Declaration]:
    """Return the declarations of the section `parameters` by name."""
    return {entry.name: _declaration(entry) for entry in section} if isinstance(section, YamlMap) else {}


def _declaration(entry: YamlEntry) -> Declaration:
    declared = entry.value
    if isinstance(declared, YamlFault):
        return Declaration(entry.key, is_faulty=True)
    if isinstance(declared, YamlScalar) and declared.value is None:
        return Declaration(entry.key)
    if not isinstance(declared, YamlMap):
        return Declaration(entry.key, default=declared)
    word = declared.get("type")
    type_ = PARAMETER_TYPES.get(word.text) if isinstance(word, YamlScalar) else None
    constraints = {name: declared.entries[name] for name in _CONSTRAINTS if declared.get(name) is not None}
    default = declared.get("default")
    # An unknown key, already reported, may be a misspelled `default`.
    is_misspelled = default is None and any(isinstance(part.value, YamlFault) for part in declared)
    is_faulty = is_misspelled or (word is not None and type_ is None)
    return Declaration(entry.key, type_, default, constraints, is_faulty)


def resolve_type(declaration: Declaration, evaluator: Evaluator) -> ParameterType | None:
    """Return the declared type, else that of the default; None after a reported error."""
    if declaration.type or declaration.is_faulty:
        return declaration.type
    if declaration.default is None:
        evaluator.sink.report(PARAMETER_WITHOUT_TYPE.at(declaration.key.span, name=declaration.name))
        return None
    value = evaluator.value(declaration.default)
    return None if value is FAULT else infer_type(value)


@dataclass(frozen=True)
class Parameter:
    """A parameter with computed constraints; None for those that are absent or faulty."""

    name: str
    type: ParameterType
    minimum: Value = None
    maximum: Value = None
    choices: tuple[Value, ...] | None = None
    pattern: Pattern | None = None

    def convert(self, value: Value, where: Span, sink: Diagnostics, names: Container[str]) -> Value:
        """Return the value converted to the parameter's type; None if it does not fit, which is reported.

        `names` are those that expressions may use where the value was written.
        """
        converted = self.type.convert(value)
        if converted is None:
            found = f"{describe(value)}{self._remedy(value, where, names)}"
            sink.report(PARAMETER_KIND.at(where, parameter=self.name, expected=self.type.words, found=found))
            return None
        violation = next(self._violations(converted, where), None)
        if violation:
            sink.report(violation)
            return None
        if self.type.name == Dimension.ANGLE and isinstance(value, int | float) and abs(value) > WIDEST_ANGLE:
            sink.report(WIDE_ANGLE.at(where, field=f"parameter '{self.name}'", found=number_text(value)))
        return converted

    def _remedy(self, value: Value, where: Span, names: Container[str]) -> str:
        """Return what to write for a text that looks like a value of another type, else ""."""
        if not isinstance(value, str):
            return ""
        if self.type.name == "boolean" and (truth := YAML_1_1_BOOLEANS.get(value.lower())):
            return f"; write {truth}"
        expression = forgotten_expression(value, where, names)
        return f"; write '{expression}'" if expression else ""

    def _violations(self, value: Value, where: Span) -> Iterator[Diagnostic]:
        name, found = self.name, describe(value)
        if self.minimum is not None and _number(value) < _number(self.minimum):
            bound, shown = _comparison(self.minimum, value)
            yield PARAMETER_TOO_SMALL.at(where, parameter=name, bound=bound, found=shown)
        if self.maximum is not None and _number(value) > _number(self.maximum):
            bound, shown = _comparison(self.maximum, value)
            yield PARAMETER_TOO_LARGE.at(where, parameter=name, bound=bound, found=shown)
        if self.choices is not None and value not in self.choices:
            choices = [_unquoted(choice) for choice in self.choices]
            near = choices if self.type.is_text else ()
            words = ", ".join(choices)
            yield PARAMETER_CHOICE.at(where, parameter=name, choices=words, name=_unquoted(value), near=near)
        if self.pattern is not None and not self.pattern.is_in(str(value)):
            yield PARAMETER_PATTERN.at(where, parameter=name, pattern=self.pattern.text, found=found)


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
    if minimum is not None and maximum is not None and _number(minimum) > _number(maximum):
        where, least, most = constraints["minimum"].span, _unquoted(minimum), _unquoted(maximum)
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


def _number(value: Value) -> float:
    number = value.value if isinstance(value, Quantity) else value
    assert isinstance(number, int | float), "only numbers have a minimum or a maximum"
    return number


def _comparison(bound: Value, value: Value) -> tuple[str, str]:
    """Return a bound and a value outside of it for a message, with SI units added if their units differ."""
    plain, quoted = _unquoted(bound), describe(value)
    if not isinstance(bound, Quantity) or not isinstance(value, Quantity):
        return plain, quoted
    if unit_text(str(bound)) == unit_text(str(value)):
        return plain, quoted
    return _with_si(plain, bound), _with_si(quoted, value)


def _with_si(text: str, quantity: Quantity) -> str:
    return text if str(quantity) == quantity.in_si else f"{text}, which is {quantity.in_si}"


def _unquoted(value: Value) -> str:
    return describe(value).strip("'")
