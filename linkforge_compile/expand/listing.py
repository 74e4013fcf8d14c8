"""What a file lets its user set: its parameters and variants, as a list for people and tools."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import NamedTuple, TypeAlias

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.expand.arguments import Arguments, Unset
from linkforge_compile.expand.evaluate_tree import Expressions
from linkforge_compile.expand.given import Given, declared_kind
from linkforge_compile.expand.loader import Loader, SpecFile
from linkforge_compile.expand.names import FileNames, Shared, UseOfFile
from linkforge_compile.expand.parameters import Declaration, parameter_of
from linkforge_compile.expand.uses import SPEC_ENDINGS, open_use
from linkforge_compile.expand.variants import Variants, variants_of
from linkforge_compile.expressions import FAULT, Value
from linkforge_compile.syntax import YamlFault, YamlList, YamlMap, YamlNode, YamlScalar
from linkforge_compile.units import Dimension, Quantity

Plain: TypeAlias = "None | bool | int | float | str | list[Plain] | dict[str, Plain]"
"""A value as JSON has it: a quantity is its number in SI units, a whole one without decimals."""


class ListedParameter(NamedTuple):
    """A parameter as its user sees it.

    `type` is None where its declaration is at fault. `unit` is the SI unit of `value`, `minimum`, `maximum` and
    `choices`, None for what has none. `default` is as written, None for a required one; `value` is what it comes
    to, None where that depends on what is not set.
    """

    name: str
    type: str | None = None
    unit: str | None = None
    default: str | None = None
    value: Plain = None
    minimum: Plain = None
    maximum: Plain = None
    choices: list[Plain] | None = None
    pattern: str | None = None
    description: str = ""

    @property
    def is_required(self) -> bool:
        return self.default is None

    @property
    def computed(self) -> str:
        """What the default comes to, as it would be written in SI units; "" where it has none."""
        return _in_si(self.value, self.unit)

    @property
    def limits(self) -> str:
        """What its value may be beside its type, such as `0.03 m to 0.5 m`, `mock | real`; "" for anything."""
        least, most = (_in_si(bound, self.unit) for bound in (self.minimum, self.maximum))
        parts = [f"{least} to {most}" if least and most else f"at least {least}" if least else f"at most {most}"]
        parts = parts if least or most else []
        if self.choices is not None:
            parts.append(" | ".join(_in_si(choice, self.unit) for choice in self.choices))
        if self.pattern is not None:
            parts.append(f"like {self.pattern}")
        return ", ".join(parts)


def _in_si(value: Plain, unit: str | None) -> str:
    """Return a value as it would be written in SI units; "" for none, and for one that is longer than a word."""
    if value is None or isinstance(value, list | dict):
        return ""
    if isinstance(value, bool):
        return "true" if value else "false"
    return f"{value} {unit}" if unit else str(value)


class Listing(NamedTuple):
    """The parameters of a file in the order written, and what each of its variants sets, as written."""

    name: str
    description: str = ""
    parameters: tuple[ListedParameter, ...] = ()
    variants: Mapping[str, Mapping[str, str]] = MappingProxyType({})


def list_parameters(spec: SpecFile, loader: Loader, sink: Diagnostics) -> Listing:
    """List what a file declares; what is wrong with it is reported, that something is not set yet is not."""
    names = _names(spec, loader, sink)
    Given(Arguments(is_partial=True), sink).tell_unknown(names.declared, Variants(variants_of(spec)), spec)
    return Listing(
        name=_text(spec.tree.get("name")),
        description=_text(spec.tree.get("description")),
        parameters=tuple(_listed(declaration, names, spec, sink) for declaration in names.declared.values()),
        variants={
            name: {entry.name: as_written(entry.value) for entry in variant}
            for name, variant in variants_of(spec).items()
        },
    )


def list_used(spec: SpecFile, loader: Loader) -> dict[str, Listing]:
    """List what each spec that a file uses lets its user set, by the text of `use`, whatever `when` says.

    Left out is what cannot be read, and a `use` that is computed; a compile tells of both.
    """
    unheard = Diagnostics()
    names = _names(spec, loader, unheard)
    section = spec.tree.get("modules")
    listed: dict[str, Listing] = {}
    for entry in section if isinstance(section, YamlMap) else ():
        use = entry.value.get("use") if isinstance(entry.value, YamlMap) else None
        if isinstance(use, YamlScalar) and use.text not in listed and use.text.lower().endswith(SPEC_ENDINGS):
            used = open_use(names.own.site(use.text, use.span), loader, unheard)
            if used:
                listed[use.text] = list_parameters(used, loader, unheard)
    return listed


def as_written(node: YamlNode) -> str:
    """Return a value on one line, as a person would write it."""
    match node:
        case YamlScalar():
            return node.text
        case YamlList():
            return f"[{', '.join(map(as_written, node))}]"
        case YamlMap():
            return f"{{{', '.join(f'{entry.name}: {as_written(entry.value)}' for entry in node)}}}"
        case YamlFault():
            return ""


def _names(spec: SpecFile, loader: Loader, sink: Diagnostics) -> FileNames:
    given = Given(Arguments(is_partial=True), sink)
    return FileNames(UseOfFile(spec, given), Shared(spec, loader, Expressions(loader.budget), Unset.NOTE), sink)


def _listed(declaration: Declaration, names: FileNames, spec: SpecFile, sink: Diagnostics) -> ListedParameter:
    section = spec.tree.get("parameters")
    declared = section.get(declaration.name) if isinstance(section, YamlMap) else None
    description = _text(declared.get("description")) if isinstance(declared, YamlMap) else ""
    default = None if declaration.default is None else as_written(declaration.default)
    kind = declared_kind(declaration, names.tree)
    if kind is None:
        return ListedParameter(declaration.name, default=default, description=description)
    parameter = parameter_of(declaration, kind, names.tree)
    in_scope = declaration.name in names.tree.scope
    value = names.tree.scope.lookup(declaration.name, sink) if in_scope else FAULT
    return ListedParameter(
        name=declaration.name,
        type=kind.name,
        unit=Dimension(kind.name).si_unit if kind.name in list(Dimension) else None,
        default=default,
        value=None if value is FAULT else _plain(value),
        minimum=_plain(parameter.minimum),
        maximum=_plain(parameter.maximum),
        choices=None if parameter.choices is None else [_plain(choice) for choice in parameter.choices],
        pattern=parameter.pattern.text if parameter.pattern else None,
        description=description,
    )


def _plain(value: Value) -> Plain:
    match value:
        case Quantity():
            return _plain(value.value)
        case float():
            return int(value) if value.is_integer() else value
        case tuple():
            return [_plain(item) for item in value]
        case Mapping():
            return {key: _plain(item) for key, item in value.items()}
    return value


def _text(node: YamlNode | None) -> str:
    return node.text if isinstance(node, YamlScalar) else ""
