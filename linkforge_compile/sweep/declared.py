"""The parameters that a spec declares, as a sweep needs them: type, constant limits, and whether a value is needed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

from linkforge_compile.analysis import Settings
from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.diagnostics.suggest import suggestion_budget
from linkforge_compile.expand.arguments import Arguments, Variants
from linkforge_compile.expand.parameter_values import BoundArguments, make_parameter
from linkforge_compile.expand.parameters import PARAMETER_TYPES, Parameter, infer_type, resolve_type
from linkforge_compile.expand.values import plain_value
from linkforge_compile.expressions import FAULT, Value
from linkforge_compile.listing import list_arguments, scope_without_arguments
from linkforge_compile.load import is_xacro
from linkforge_compile.source import Span
from linkforge_compile.sweep.errors import SweepError
from linkforge_compile.syntax import YamlEntry, YamlScalar, scalar_value


class Declared(NamedTuple):
    """What a file declares.

    - `parameters`: their types and limits, without limits that are computed from names: a sweep may set these. The
      type of an argument of a xacro, which has none, follows from its values: its entry is None.
    - `required`: the names of those without a default.
    - `variants`: the names of the file's variants.
    """

    parameters: Mapping[str, Parameter | None]
    required: frozenset[str]
    variants: tuple[str, ...]


@suggestion_budget()
def declared_by(spec: Path, settings: Settings) -> Declared:
    """Return what a spec declares; SweepError with its faults if it cannot be read."""
    sink, loader = Diagnostics(), settings.loader(spec)
    if is_xacro(spec):
        listing = list_arguments(spec, loader, sink)
        if listing is None:
            raise SweepError(f"'{spec}' cannot be read", sink.sorted())
        required = frozenset(one.name for one in listing.parameters if one.is_required)
        return Declared({one.name: None for one in listing.parameters}, required, ())
    file = loader.open(spec, sink)
    if file is None or sink.has_errors:
        raise SweepError(f"'{spec}' has errors", sink.sorted())
    scope = scope_without_arguments(file, loader, sink)
    parameters: dict[str, Parameter | None] = {}
    quiet = replace(scope.evaluator, sink=Diagnostics())
    for name, declaration in scope.declared.items():
        constant = {
            key: entry
            for key, entry in declaration.constraints.items()
            if not (quiet.expressions.is_computed(entry.value) and (quiet.names_in(entry.value) or key == "enum"))
        }
        type_ = resolve_type(declaration, quiet)
        limited = replace(declaration, constraints=constant)
        parameters[name] = None if type_ is None else make_parameter(limited, type_, quiet)
    required = frozenset(name for name, one in scope.declared.items() if one.default is None and not one.is_faulty)
    return Declared(parameters, required, tuple(Variants.of(file).by_name))


def value_of(text: str, where: Span, parameter: Parameter | None, sink: Diagnostics) -> Value:
    """Return a text as a value of a parameter, as on the command line; None after a reported error.

    Lists, maps and vectors remain texts, which a column of the table can hold.
    """
    if parameter is None:
        return text
    if parameter.type.is_structured:
        return text if _is_structure(text, where, parameter, sink) else None
    if parameter.type.is_text:
        return parameter.convert(text, where, sink, ())
    value = plain_value(YamlScalar(text, scalar_value(text), where))
    return None if value is FAULT else parameter.convert(value, where, sink, ())


def _is_structure(text: str, where: Span, parameter: Parameter, sink: Diagnostics) -> bool:
    key, node = YamlScalar(parameter.name, parameter.name, where), YamlScalar(text, text, where)
    arguments = Arguments({parameter.name: YamlEntry(key, node)}, Path(), as_text=True)
    parsed = BoundArguments(arguments, sink).node(parameter.name, parameter.type)
    value = FAULT if parsed is None else plain_value(parsed)
    return value is not FAULT and parameter.convert(value, where, sink, ()) is not None


def untyped(name: str, texts: list[str], where: Span) -> Parameter:
    """Return the parameter that an argument of a xacro is, by its values: numbers with or without units, or text."""
    values = [plain_value(YamlScalar(text, scalar_value(text), where)) for text in texts]
    types = {infer_type(value).name for value in values if value is not FAULT}
    return Parameter(name, PARAMETER_TYPES[types.pop() if len(types) == 1 else "string"])
