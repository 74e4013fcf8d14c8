"""List what a file lets its user set, for people and tools: parameters and variants, or a xacro's arguments."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import NamedTuple, TypeAlias

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.expand.arguments import Arguments, Unset, Variants
from linkforge_compile.expand.evaluate import Expressions
from linkforge_compile.expand.file_scope import CompileState, FileScope, Use
from linkforge_compile.expand.parameter_values import BoundArguments, make_parameter
from linkforge_compile.expand.parameters import Declaration, resolve_type
from linkforge_compile.expressions import FAULT, Value
from linkforge_compile.load.loader import ImportSite, Loader, SpecFile
from linkforge_compile.load.locations import SPEC_ENDINGS, PathSite, locate, names_xacro, open_use
from linkforge_compile.load.macro_roles import MacroRoles
from linkforge_compile.load.xacro_library import Macro, read_library
from linkforge_compile.syntax import YamlFault, YamlList, YamlMap, YamlNode, YamlScalar
from linkforge_compile.units import Dimension, Quantity

Plain: TypeAlias = "None | bool | int | float | str | list[Plain] | dict[str, Plain]"
"""A value as in JSON: a quantity is its number in SI units, a whole number has no decimals."""


class ListedParameter(NamedTuple):
    """A parameter as its user sees it.

    - `type`: None if the declaration is faulty.
    - `unit`: the SI unit of `value`, `minimum`, `maximum` and `choices`, None for none.
    - `default`: as written, None for a required parameter.
    - `value`: the computed default, None if it depends on parameters without a value.
    - `field`: the field of an entry of `modules` that gives it, None for a parameter that `with` gives.
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
    field: str | None = None

    @property
    def is_required(self) -> bool:
        return self.default is None and self.field is None

    @property
    def computed(self) -> str:
        """The computed default in SI units, "" for none."""
        return _in_si(self.value, self.unit)

    @property
    def limits(self) -> str:
        """The constraints in short, such as `0.03 m to 0.5 m` or `mock | real`; "" for none."""
        least, most = (_in_si(bound, self.unit) for bound in (self.minimum, self.maximum))
        parts = [f"{least} to {most}" if least and most else f"at least {least}" if least else f"at most {most}"]
        parts = parts if least or most else []
        if self.choices is not None:
            parts.append(" | ".join(_in_si(choice, self.unit) for choice in self.choices))
        if self.pattern is not None:
            parts.append(f"like {self.pattern}")
        return ", ".join(parts)


def _in_si(value: Plain, unit: str | None) -> str:
    """Return a value as written in SI units; "" for none, and for lists and maps."""
    if value is None or isinstance(value, list | dict):
        return ""
    if isinstance(value, bool):
        return "true" if value else "false"
    return f"{value} {unit}" if unit else str(value)


class Listing(NamedTuple):
    """The parameters of a file in the order written, and the settings of each variant, as written.

    `macros` are those of a xacro with their parameters; the type of a block is XML.
    """

    name: str
    description: str = ""
    parameters: tuple[ListedParameter, ...] = ()
    variants: Mapping[str, Mapping[str, str]] = MappingProxyType({})
    macros: Mapping[str, Sequence[ListedParameter]] = MappingProxyType({})

    def settable(self, macro: str | None = None) -> tuple[ListedParameter, ...]:
        """Return what `with` of a module may have: for the file, or for a macro of it, if it has that."""
        return (*self.macros.get(macro or "", ()), *self.parameters)


def list_parameters(spec: SpecFile, loader: Loader, sink: Diagnostics) -> Listing:
    """List what a file declares; faults are reported, but not parameters without a value."""
    scope = scope_without_arguments(spec, loader, sink)
    variants = Variants.of(spec)
    BoundArguments(Arguments(is_partial=True), sink).report_unknown(scope.declared, variants, spec)
    return Listing(
        name=spec.tree.text("name") or "",
        description=spec.tree.text("description") or "",
        parameters=tuple(_listed(declaration, scope, spec, sink) for declaration in scope.declared.values()),
        variants={
            name: {entry.name: as_written(entry.value) for entry in variant}
            for name, variant in variants.by_name.items()
        },
    )


def list_used(spec: SpecFile, loader: Loader) -> dict[str, Listing]:
    """List what each spec or xacro that a file uses declares, by the text of `use`, whether or not its `when` holds.

    A file that cannot be read is omitted, as is a computed `use`; compiling reports them.
    """
    scope = scope_without_arguments(spec, loader, Diagnostics())
    listed: dict[str, Listing | None] = {}
    for entry in spec.tree.section("modules").values():
        use = entry.value.get("use") if isinstance(entry.value, YamlMap) else None
        if isinstance(use, YamlScalar) and use.text not in listed:
            listed[use.text] = _list_module(scope.site(use.text, use.span), loader, Diagnostics())
    return {use: listing for use, listing in listed.items() if listing}


def list_use(spec: SpecFile, use: YamlScalar, loader: Loader) -> Listing | None:
    """List what one spec or xacro that a file uses declares; None as for `list_used`."""
    scope = scope_without_arguments(spec, loader, Diagnostics())
    return _list_module(scope.site(use.text, use.span), loader, Diagnostics())


def _list_module(site: PathSite, loader: Loader, sink: Diagnostics) -> Listing | None:
    """List what the spec or xacro at a site declares; None for any other file, and after a reported error."""
    lowered = site.text.lower()
    if names_xacro(site, loader):
        target = locate(site, loader, sink)
        return list_arguments(target.path, loader, sink, site.used) if target else None
    used = open_use(site, loader, sink) if lowered.endswith(SPEC_ENDINGS) else None
    return list_parameters(used, loader, sink) if used else None


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


def scope_without_arguments(spec: SpecFile, loader: Loader, sink: Diagnostics) -> FileScope:
    state = CompileState(spec, loader, Expressions(loader.budget), Unset.NOTE)
    return FileScope(Use(spec, BoundArguments(Arguments(is_partial=True), sink)), state, sink)


def _listed(declaration: Declaration, scope: FileScope, spec: SpecFile, sink: Diagnostics) -> ListedParameter:
    declared = spec.tree.section("parameters")[declaration.name].value
    description = (declared.text("description") if isinstance(declared, YamlMap) else None) or ""
    default = None if declaration.default is None else as_written(declaration.default)
    type_ = resolve_type(declaration, scope.evaluator)
    if type_ is None:
        return ListedParameter(declaration.name, default=default, description=description)
    parameter = make_parameter(declaration, type_, scope.evaluator)
    names = scope.evaluator.scope
    value = names.lookup(declaration.name, sink) if declaration.name in names else FAULT
    return ListedParameter(
        name=declaration.name,
        type=type_.name,
        unit=Dimension(type_.name).si_unit if type_.name in list(Dimension) else None,
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


# The arguments and macros of a xacro file


def list_arguments(path: Path, loader: Loader, sink: Diagnostics, used: ImportSite | None = None) -> Listing | None:
    """List the arguments and macros of a xacro file; None after a reported error.

    `used` is where a spec names the file, which it may then not be allowed to read; None for the command line. An
    argument has its first default, and one that is used but not declared is required. Notes report the includes that
    cannot be followed.
    """
    library = read_library(path, loader, sink, used)
    if library is None:
        return None
    sink.report_all(library.notes)
    declared = [
        ListedParameter(name, "string", default=None if name in library.early else default)
        for name, default in library.arguments.items()
    ]
    undeclared = [ListedParameter(name, "string") for name in library.used if name not in library.arguments]
    name, roles = library.name, MacroRoles(library)
    return Listing(
        name if name and "$" not in name else path.name,
        parameters=(*declared, *undeclared),
        macros={one.name: tuple(_listed_of_macro(one, roles)) for one in library.macros.values()},
    )


def _listed_of_macro(macro: Macro, roles: MacroRoles) -> Iterator[ListedParameter]:
    fields = roles.fields(macro)
    for one in macro.parameters:
        kind = "string" if one.block is None else "XML"
        yield ListedParameter(one.name, kind, default=one.written_default, field=fields.get(one.name))
