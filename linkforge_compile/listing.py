"""List what a file lets its user set, for people and tools: parameters and variants, or a xacro's arguments."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.diagnostics.codes.importing import ARGUMENTS_NOT_LISTED
from linkforge_compile.expand.arguments import Arguments, Unset, Variants
from linkforge_compile.expand.evaluate import Expressions
from linkforge_compile.expand.file_scope import CompileState, FileScope, Use
from linkforge_compile.expand.parameter_values import BoundArguments, make_parameter
from linkforge_compile.expand.parameters import Declaration, resolve_type
from linkforge_compile.expressions import FAULT, Value
from linkforge_compile.load.loader import ImportSite, Loader, SpecFile
from linkforge_compile.load.locations import SPEC_ENDINGS, PathSite, locate, names_xacro, open_use
from linkforge_compile.paths import folders_for_xacro
from linkforge_compile.roots import identity
from linkforge_compile.syntax import YamlFault, YamlList, YamlMap, YamlNode, YamlScalar
from linkforge_compile.units import Dimension, Quantity

if TYPE_CHECKING:
    from linkforge_compile.source import SourceFile, Span
    from linkforge_compile.source.xml_tree import XmlElement

Plain: TypeAlias = "None | bool | int | float | str | list[Plain] | dict[str, Plain]"
"""A value as in JSON: a quantity is its number in SI units, a whole number has no decimals."""


class ListedParameter(NamedTuple):
    """A parameter as its user sees it.

    - `type`: None if the declaration is faulty.
    - `unit`: the SI unit of `value`, `minimum`, `maximum` and `choices`, None for none.
    - `default`: as written, None for a required parameter.
    - `value`: the computed default, None if it depends on parameters without a value.
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
    """The parameters of a file in the order written, and the settings of each variant, as written."""

    name: str
    description: str = ""
    parameters: tuple[ListedParameter, ...] = ()
    variants: Mapping[str, Mapping[str, str]] = MappingProxyType({})


def list_parameters(spec: SpecFile, loader: Loader, sink: Diagnostics) -> Listing:
    """List what a file declares; faults are reported, but not parameters without a value."""
    scope = _scope_without_arguments(spec, loader, sink)
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

    A file that cannot be read is left out, as is a computed `use`; compiling reports them.
    """
    scope = _scope_without_arguments(spec, loader, Diagnostics())
    listed: dict[str, Listing | None] = {}
    for entry in spec.tree.section("modules").values():
        use = entry.value.get("use") if isinstance(entry.value, YamlMap) else None
        if isinstance(use, YamlScalar) and use.text not in listed:
            listed[use.text] = _list_module(scope.site(use.text, use.span), loader, Diagnostics())
    return {use: listing for use, listing in listed.items() if listing}


def list_use(spec: SpecFile, use: YamlScalar, loader: Loader) -> Listing | None:
    """List what one spec or xacro that a file uses declares; None as for `list_used`."""
    scope = _scope_without_arguments(spec, loader, Diagnostics())
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


def _scope_without_arguments(spec: SpecFile, loader: Loader, sink: Diagnostics) -> FileScope:
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


# The arguments of a xacro file, found by reading it and what it includes, without running xacro.

_ARG_USE = re.compile(r"\$\(arg\s+([^\s()]+)\s*\)")
_SUBSTITUTION = re.compile(r"\$\((find|arg|dirname)\s*([^\s()]*)\s*\)")
_MAX_INCLUDE_DEPTH = 50
_COMPUTED_NAME = "its name is known only as xacro runs"


def list_arguments(path: Path, loader: Loader, sink: Diagnostics, used: ImportSite | None = None) -> Listing | None:
    """List the arguments of a xacro file, each with its first default; None after a reported error.

    `used` is where a spec names the file, which it may then not be allowed to read; None for the command line.

    A note reports an include that cannot be followed, because its name is computed or it cannot be read. Conditions
    are ignored. An argument that is used but not declared is required.
    """
    file = loader.open_xml(path, sink, used)
    root = _read_root(file, sink) if file else None
    if root is None:
        return None
    search = _ArgumentSearch(loader, sink)
    search.search(root, path)
    # xacro evaluates the attributes of <robot> first, before it has seen any default.
    early = set(_ARG_USE.findall(" ".join(root.values.values())))
    declared = [one._replace(default=None) if one.name in early else one for one in search.declared.values()]
    undeclared = [ListedParameter(name, "string") for name in search.used if name not in search.declared]
    name = root.get("name")
    return Listing(name if name and "$" not in name else path.name, parameters=(*declared, *undeclared))


def _read_root(file: SourceFile, sink: Diagnostics) -> XmlElement | None:
    from linkforge_compile.importers.xml import read_xml

    document = read_xml(file, sink)
    return document.root if document else None


class _NotListedError(Exception):
    """An include cannot be followed; the message says why."""


class _ArgumentSearch:
    """Searches a xacro file and all that it includes, each once."""

    def __init__(self, loader: Loader, sink: Diagnostics) -> None:
        self.declared: dict[str, ListedParameter] = {}
        self.used: dict[str, None] = {}
        self._loader, self._sink = loader, sink
        self._seen: set[str] = set()

    def search(self, root: XmlElement, path: Path, depth: int = 0) -> None:
        self._seen.add(identity(path))
        for element in root.walk():
            name, included = element.get("name"), element.get("filename")
            if element.tag == "xacro:arg" and name:
                self.declared.setdefault(name, ListedParameter(name, "string", default=element.get("default")))
            elif element.tag == "xacro:include" and included is not None:
                self._include(included, element, path, depth)
        self.used |= dict.fromkeys(_ARG_USE.findall(root.raw))

    def _include(self, name: str, element: XmlElement, user: Path, depth: int) -> None:
        try:
            path = user.parent / self._resolve(name, user)
            if identity(path) in self._seen:
                return
            root = self._open(path, name, element.span, depth)
        except _NotListedError as error:
            if element.get("optional") not in ("true", "True", "1"):
                self._sink.report(ARGUMENTS_NOT_LISTED.at(element.span, path=name, reason=str(error)))
            return
        self.search(root, path, depth + 1)

    def _open(self, path: Path, name: str, place: Span, depth: int) -> XmlElement:
        if depth == _MAX_INCLUDE_DEPTH:
            raise _NotListedError(f"more than {_MAX_INCLUDE_DEPTH} files include each other")
        faults = Diagnostics()
        file = self._loader.open_xml(path, faults, ImportSite(name, place))
        root = _read_root(file, faults) if file else None
        if root is None:
            raise _NotListedError(next(iter(faults)).message)
        return root

    def _resolve(self, name: str, user: Path) -> str:
        """Return a file name with its substitutions replaced."""
        text = _SUBSTITUTION.sub(lambda found: self._value(found[1], found[2], user), name)
        if "$" in text or re.search(r"[*?\[]", text):
            raise _NotListedError(_COMPUTED_NAME)
        return text

    def _value(self, kind: str, name: str, user: Path) -> str:
        if kind == "dirname":
            return str(user.parent.absolute())
        if kind == "find":
            folder = next(folders_for_xacro(name, self._loader.packages, user.parent, self._loader.roots), None)
            if folder is None:
                raise _NotListedError(f"no package named '{name}'; say where it is with --package {name}=FOLDER")
            return str(folder)
        argument = self.declared.get(name)
        if argument is None or argument.default is None or "$" in argument.default:
            raise _NotListedError(_COMPUTED_NAME)
        return argument.default
