"""Make the call of a macro of a xacro file that an entry of `modules` means.

Macros are written to be called in a robot. Most take the link to which they attach their own joint, the place of that
joint as a block, and a prefix for their names, which an entry of `modules` has as `parent`, `origin` and `prefix`:

    <xacro:macro name="lidar" params="prefix parent *origin">
      <link name="${prefix}laser"/>
      <joint name="${prefix}laser_joint" type="fixed">
        <xacro:insert_block name="origin"/><parent link="${parent}"/><child link="${prefix}laser"/>
      </joint>
    </xacro:macro>

So these go where the macro wants them, and a prefix that it puts is not put twice.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Literal, NamedTuple

from linkforge_compile.diagnostics import Diagnostic, Diagnostics, Note
from linkforge_compile.diagnostics.codes.importing import (
    MACRO_BLOCK,
    MACRO_SETS_FIELD,
    XACRO_UNKNOWN_NAME,
)
from linkforge_compile.diagnostics.codes.modules import PARAMETER_NOT_SET, UNKNOWN_PARAMETER
from linkforge_compile.diagnostics.enumerations import listed
from linkforge_compile.diagnostics.suggest import nearest
from linkforge_compile.load.loader import Loader, SpecFile
from linkforge_compile.load.xacro import XacroArgument, XacroUse, open_xacro
from linkforge_compile.load.xacro_library import Macro, MacroParameter, XacroLibrary, read_library
from linkforge_compile.source import SourceFile
from linkforge_compile.source.malformed_xml import MalformedXmlError
from linkforge_compile.source.xml_tree import parse_xml
from linkforge_compile.syntax import YamlNode, YamlScalar

if TYPE_CHECKING:
    from linkforge_compile.source.xml_tree import XmlDocument, XmlElement

ORIGIN = "origin"
"""The block that an entry of `modules` gives as its `origin`."""

STAND_IN = "world"
"""The parent of a macro that is used without one."""

_IDENTITY = '<origin xyz="0 0 0" rpy="0 0 0" {}=""/>'
"""A block in place of which the entry has the origin; it has the mark of a place that is in no file."""


class MacroEntry(NamedTuple):
    """An entry of `modules` with `macro`; `prefix` is in force, and `has_prefix` if it is written."""

    name: str
    macro: YamlScalar
    parent: YamlScalar | None
    origin: YamlNode | None
    prefix: str
    has_prefix: bool


class MacroResult(NamedTuple):
    """What a call makes; `prefix` is still to be put before its names.

    `parent` is the link, not among its own, to which it attaches its joint; `placed` are the names of the joints there
    whose origin is that of the entry, None for all of them.
    """

    spec: SpecFile
    prefix: str
    parent: YamlScalar
    placed: frozenset[str] | None

    def is_placed(self, joint: str) -> bool:
        return self.placed is None or joint in self.placed


def call_macro(use: XacroUse, entry: MacroEntry, loader: Loader, sink: Diagnostics) -> MacroResult | None:
    """Call a macro of a xacro file and read what it makes as a spec; None after a reported error.

    The arguments of the use are for the macro, and for the file.
    """
    from linkforge_compile.importers.xacro import MacroCall

    library = read_library(use.path, loader, sink, use.used) if use.arguments is not None else None
    macro = _find(entry.macro, library, sink) if library else None
    if library is None or macro is None:
        return None
    arguments = _Arguments(use.arguments or {}, entry, macro, library, sink)
    blocks = tuple(filter(None, map(arguments.block, macro.blocks)))
    arguments.require_all()
    if arguments.is_faulty:
        return None
    call = MacroCall(macro.name, {name: one.text for name, one in arguments.values.items()}, blocks)
    scan = _Scan(arguments.parent.text)
    use = replace(use, arguments=arguments.of_file, used_elsewhere=None, call=call)
    spec = open_xacro(use, loader, sink, scan.look_at)
    placed = None if arguments.is_placed_by_entry else frozenset(scan.joints)
    return MacroResult(spec, arguments.prefix, arguments.parent, placed) if spec else None


def _find(name: YamlScalar, library: XacroLibrary, sink: Diagnostics) -> Macro | None:
    macro = library.macros.get(name.text)
    if macro is None:
        notes = [Note(one.message, one.span) for one in library.notes]
        known = library.macros
        if known and not nearest(name.text, known):
            notes.append(Note(f"its macros are {listed([*known], 'and')}"))
        sink.report(XACRO_UNKNOWN_NAME.at(name.span, kind="macro", name=name.text, near=known, notes=notes))
    return macro


@dataclass
class _Arguments:
    """Shares what an entry gives among the parameters and blocks of a macro, and the arguments of its file."""

    given: Mapping[str, XacroArgument]
    entry: MacroEntry
    macro: Macro
    library: XacroLibrary
    sink: Diagnostics
    values: dict[str, XacroArgument] = field(default_factory=dict)
    """The texts of the parameters."""
    of_file: dict[str, XacroArgument] = field(default_factory=dict)
    """The `<xacro:arg>` of the file."""
    is_faulty: bool = False
    prefix: str = ""
    parent: YamlScalar = field(init=False)
    """The link to which the macro attaches its joint."""
    is_placed_by_entry: bool = False
    """Whether the macro takes its place in the parameters of an `xyz` and an `rpy`, and the entry gives it instead."""

    def __post_init__(self) -> None:
        for name, argument in self.given.items():
            parameter = self.macro.parameter(name)
            if parameter and not parameter.block:
                self.values[name] = argument
            elif not parameter:
                self._give_to_file(name, argument)
        roles = [*_roles(self.macro, self.library, frozenset())]
        self._set_prefix(_own_prefix(self.macro, roles))
        own = {*_parameters_with("link", self.macro, roles)}
        parents = (name for name in _parameters_with("parent", self.macro, roles) if name not in own)
        self._set_parent(next(parents, None))
        self._set_place([next(_parameters_with(kind, self.macro, roles), None) for kind in ("xyz", "rpy")])

    def _give_to_file(self, name: str, argument: XacroArgument) -> None:
        known = (*(one.name for one in self.macro.parameters), *self.library.arguments, *self.library.used)
        if name in known:
            self.of_file[name] = argument
            return
        declared = Note(f"macro '{self.macro.name}' is declared here", self.macro.element.span)
        self._report(UNKNOWN_PARAMETER.at(argument.where, name=name, near=known, notes=[declared]))

    def _set_prefix(self, own: _OwnPrefix | None) -> None:
        entry = self.entry
        if own is None:
            self.prefix = entry.prefix
        elif own.name in self.values:
            if entry.has_prefix:
                self._refuse(own.name, "prefix")
        else:
            text = entry.prefix.removesuffix("_") if own.adds_underscore else entry.prefix
            self.values[own.name] = XacroArgument(text, entry.macro.span)

    def _set_parent(self, own: str | None) -> None:
        entry = self.entry
        self.parent = entry.parent or YamlScalar(STAND_IN, STAND_IN, entry.macro.span)
        given = self.values.get(own) if own else None
        if own is None:
            return
        if given is None:
            self.values[own] = XacroArgument(self.parent.text, self.parent.span)
        elif entry.parent is None:
            self.parent = YamlScalar(given.text, given.text, given.where)
        else:
            self._refuse(own, "parent")

    def _set_place(self, own: Sequence[str | None]) -> None:
        names = [name for name in own if name and name not in self.values]
        parameters = [one for name in names if (one := self.macro.parameter(name))]
        if len(parameters) == len(own) and (self.entry.origin or all(one.is_required for one in parameters)):
            self.is_placed_by_entry = True
            self.values |= {name: XacroArgument("0 0 0", self.entry.macro.span) for name in names}

    def _refuse(self, parameter: str, field: str) -> None:
        where, name = self.values[parameter].where, self.entry.name
        self._report(MACRO_SETS_FIELD.at(where, field=field, name=name, parameter=parameter))

    def block(self, parameter: MacroParameter) -> str | None:
        """Return the XML of a block; None after a reported error."""
        from linkforge_compile.importers.xacro.process import MARK

        given = self.given.get(parameter.name)
        if given is None and parameter.name == ORIGIN and parameter.block == "*":
            return _IDENTITY.format(MARK)
        if given is None:
            self._require(parameter)
            return None
        elements = _elements_in(given.text)
        if elements is None or (parameter.block == "*" and elements != 1):
            what = "one element" if parameter.block == "*" else "elements"
            self._report(MACRO_BLOCK.at(given.where, name=parameter.name, what=what, found=given.text))
            return None
        return given.text if parameter.block == "*" else f"<block>{given.text}</block>"

    def require_all(self) -> None:
        """Report the parameters without a value."""
        for parameter in self.macro.parameters:
            if parameter.is_required and not parameter.block and parameter.name not in self.values:
                self._require(parameter)

    def _require(self, parameter: MacroParameter) -> None:
        kind, value = ("block", "'<…/>'") if parameter.block else ("parameter", "VALUE")
        what = f"{kind} '{parameter.name}' of macro '{self.macro.name}' has"
        notes = [Note("the macro is declared here", self.macro.element.span)]
        remedy = f"'with: {{{parameter.name}: {value}}}'"
        self._report(PARAMETER_NOT_SET.at(self.entry.macro.span, what=what, remedy=remedy, notes=notes))

    def _report(self, diagnostic: Diagnostic) -> None:
        self.is_faulty = True
        self.sink.report(diagnostic)


def _elements_in(text: str) -> int | None:
    """Return how many elements a text has side by side, and nothing else; None if it is no such XML."""
    try:
        root = parse_xml(SourceFile("<block>", f"<block>{text}</block>")).root
    except MalformedXmlError:
        return None
    return None if root.text.strip() or not root.children else len(root.children)


# What a macro does with its parameters, as it is written


class _OwnPrefix(NamedTuple):
    """The parameter that a macro puts before its names; some add an underscore themselves."""

    name: str
    adds_underscore: bool


class _Role(NamedTuple):
    """What a parameter is for: the link above a joint, its place there, a link of the macro, or the start of names."""

    parameter: str
    kind: Literal["parent", "xyz", "rpy", "link", "prefix", "prefix_"]


_ONLY = re.compile(r"\s*\$\{\s*(\w+)\s*\}\s*")
_FIRST = re.compile(r"\s*\$\{\s*(\w+)\s*\}(_)?")


def _parameters_with(kind: str, macro: Macro, roles: Iterable[_Role]) -> Iterator[str]:
    return (role.parameter for role in roles if role.kind == kind and macro.parameter(role.parameter))


def _own_prefix(macro: Macro, roles: Iterable[_Role]) -> _OwnPrefix | None:
    named = [role for role in roles if "prefix" in role.kind and "prefix" in role.parameter]
    name = next((role.parameter for role in named if macro.parameter(role.parameter)), None)
    if name is None:
        return None
    return _OwnPrefix(name, all(role.kind == "prefix_" for role in named if role.parameter == name))


def _roles(macro: Macro, library: XacroLibrary, callers: frozenset[str]) -> Iterator[_Role]:
    """Yield what names in a macro are for, also in the macros that it calls."""
    for element in macro.element.walk():
        if element.tag == "joint":
            yield from _roles_in_joint(element)
        if element.tag == "link" and (found := _ONLY.fullmatch(element.get("name") or "")):
            yield _Role(found[1], "link")
        if element.tag in ("link", "joint") and (found := _FIRST.match(element.get("name") or "")):
            yield _Role(found[1], "prefix_" if found[2] else "prefix")
        called = library.macros.get(element.tag.removeprefix("xacro:")) if element.tag.startswith("xacro:") else None
        if called and called.name not in callers:
            inner = _roles(called, library, callers | {macro.name})
            yield from filter(None, (_role_outside(role, called, element) for role in inner))


def _roles_in_joint(joint: XmlElement) -> Iterator[_Role]:
    """Yield the parameters that are the parent of a joint, and its place there."""
    by_tag = {child.tag: child for child in joint.children}
    parent = _ONLY.fullmatch(by_tag["parent"].get("link") or "") if "parent" in by_tag else None
    if parent is None:
        return
    yield _Role(parent[1], "parent")
    kinds: tuple[Literal["xyz", "rpy"], ...] = ("xyz", "rpy")
    for kind in kinds:
        if "origin" in by_tag and (found := _ONLY.fullmatch(by_tag["origin"].get(kind) or "")):
            yield _Role(found[1], kind)


def _role_outside(role: _Role, called: Macro, call: XmlElement) -> _Role | None:
    """Return what a role of a parameter of a called macro is around the call."""
    parameter, given = called.parameter(role.parameter), call.get(role.parameter)
    if given is None:
        return role if parameter and parameter.is_forwarded else None
    if found := _ONLY.fullmatch(given):
        return _Role(found[1], role.kind)
    if "prefix" in role.kind and (found := _FIRST.match(given)):
        return _Role(found[1], "prefix_" if found[2] else "prefix")
    return None


# What the call made


class _Scan:
    """Finds in the expanded document which joints to the parent have the block that stands for the entry's origin."""

    def __init__(self, parent: str) -> None:
        self._parent = parent
        self.joints: set[str] = set()

    def look_at(self, document: XmlDocument) -> None:
        from linkforge_compile.importers.xacro.process import MARK

        for joint in document.root.children:
            links = [child.get("link") for child in joint.children if child.tag == "parent"]
            origins = [child for child in joint.children if child.tag == "origin"]
            if joint.tag == "joint" and links == [self._parent] and any(one.get(MARK) == "" for one in origins):
                self.joints.add(joint.get("name") or "")
