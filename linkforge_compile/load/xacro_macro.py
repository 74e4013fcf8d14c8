"""Open a macro of a xacro file as a module: make the call that an entry of `modules` means, and attach what it makes.

Macros are written to be called in a robot. Most take the link to which they attach their own joint, the place of that
joint as a block, and a prefix for their names, which an entry of `modules` has as `parent`, `origin` and `prefix`:

    <xacro:macro name="lidar" params="prefix parent *origin">
      <link name="${prefix}laser"/>
      <joint name="${prefix}laser_joint" type="fixed">
        <xacro:insert_block name="origin"/><parent link="${parent}"/><child link="${prefix}laser"/>
      </joint>
    </xacro:macro>

So the joint to the parent becomes the `mount` of the module, and a prefix that the macro puts is not put twice.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Literal, NamedTuple

from linkforge_compile.diagnostics import Diagnostic, Diagnostics, Note
from linkforge_compile.diagnostics.codes.importing import (
    MACRO_BLOCK,
    MACRO_PLACES_ITSELF,
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
from linkforge_compile.syntax import YamlEntry, YamlMap, YamlNode, YamlScalar

if TYPE_CHECKING:
    from linkforge_compile.source.xml_tree import XmlDocument

ORIGIN = "origin"
"""The block that an entry of `modules` gives as its `origin`."""

_STAND_IN = "world"
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


class MacroModule(NamedTuple):
    """What a call makes; `prefix` is still to be put before its names.

    `parent` and `origin` are those of the joint that attaches it, where `with` or the macro itself sets them.
    """

    spec: SpecFile
    prefix: str
    parent: YamlScalar | None = None
    origin: YamlNode | None = None


def open_macro(use: XacroUse, entry: MacroEntry, loader: Loader, sink: Diagnostics) -> MacroModule | None:
    """Call a macro of a xacro file and read what it makes as a module; None after a reported error.

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
    return _attached(spec, arguments, scan) if spec else None


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
    has_origin: bool = False
    """Whether the macro takes the origin of the entry as a block."""

    def __post_init__(self) -> None:
        for name, argument in self.given.items():
            parameter = self.macro.parameter(name)
            if parameter and not parameter.block:
                self.values[name] = argument
            elif not parameter:
                self._give_to_file(name, argument)
        self._set_prefix()
        self._set_parent()

    def _give_to_file(self, name: str, argument: XacroArgument) -> None:
        known = (*(one.name for one in self.macro.parameters), *self.library.arguments, *self.library.used)
        if name in known:
            self.of_file[name] = argument
            return
        declared = Note(f"macro '{self.macro.name}' is declared here", self.macro.element.span)
        self._report(UNKNOWN_PARAMETER.at(argument.where, name=name, near=known, notes=[declared]))

    def _set_prefix(self) -> None:
        entry, own = self.entry, _own_prefix(self.macro, self.library)
        if own is None:
            self.prefix = entry.prefix
        elif own.name in self.values:
            if entry.has_prefix:
                self._refuse(own.name, "prefix")
        else:
            text = entry.prefix.removesuffix("_") if own.adds_underscore else entry.prefix
            self.values[own.name] = XacroArgument(text, entry.macro.span)

    def _set_parent(self) -> None:
        entry, own = self.entry, _own_parent(self.macro, self.library)
        self.parent = entry.parent or YamlScalar(_STAND_IN, _STAND_IN, entry.macro.span)
        given = self.values.get(own) if own else None
        if own is None:
            return
        if given is None:
            self.values[own] = XacroArgument(self.parent.text, self.parent.span)
        elif entry.parent is None:
            self.parent = YamlScalar(given.text, given.text, given.where)
        else:
            self._refuse(own, "parent")

    def _refuse(self, parameter: str, field: str) -> None:
        where, name = self.values[parameter].where, self.entry.name
        self._report(MACRO_SETS_FIELD.at(where, field=field, name=name, parameter=parameter))

    def block(self, parameter: MacroParameter) -> str | None:
        """Return the XML of a block; None after a reported error."""
        from linkforge_compile.importers.xacro.process import MARK

        given = self.given.get(parameter.name)
        if given is None and parameter.name == ORIGIN and parameter.block == "*":
            self.has_origin = True
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
    """What a parameter is for: the link above a joint, or the beginning of names."""

    parameter: str
    kind: Literal["parent", "prefix", "prefix_"]


_ONLY = re.compile(r"\s*\$\{\s*(\w+)\s*\}\s*")
_FIRST = re.compile(r"\s*\$\{\s*(\w+)\s*\}(_)?")


def _own_parent(macro: Macro, library: XacroLibrary) -> str | None:
    names = (role.parameter for role in _roles(macro, library, frozenset()) if role.kind == "parent")
    return next((name for name in names if macro.parameter(name)), None)


def _own_prefix(macro: Macro, library: XacroLibrary) -> _OwnPrefix | None:
    roles = [role for role in _roles(macro, library, frozenset()) if role.kind != "parent"]
    named = [role for role in roles if "prefix" in role.parameter and macro.parameter(role.parameter)]
    if not named:
        return None
    name = named[0].parameter
    return _OwnPrefix(name, all(role.kind == "prefix_" for role in named if role.parameter == name))


def _roles(macro: Macro, library: XacroLibrary, callers: frozenset[str]) -> Iterator[_Role]:
    """Yield what names in a macro are for, also in the macros that it calls."""
    for element in macro.element.walk():
        if element.tag == "parent" and (found := _ONLY.fullmatch(element.get("link") or "")):
            yield _Role(found[1], "parent")
        elif element.tag in ("link", "joint") and (found := _FIRST.match(element.get("name") or "")):
            yield _Role(found[1], "prefix_" if found[2] else "prefix")
        called = library.macros.get(element.tag.removeprefix("xacro:")) if element.tag.startswith("xacro:") else None
        if called and called.name not in callers:
            for role in _roles(called, library, callers | {macro.name}):
                parameter = called.parameter(role.parameter)
                given = element.get(role.parameter)
                if given is None and parameter and parameter.is_forwarded:
                    yield role
                elif given and (found := _ONLY.fullmatch(given)):
                    yield _Role(found[1], role.kind)
                elif given and role.kind != "parent" and (found := _FIRST.match(given)):
                    yield _Role(found[1], "prefix_" if found[2] else "prefix")


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


def _attached(spec: SpecFile, arguments: _Arguments, scan: _Scan) -> MacroModule:
    """Return the module with its joint to the parent as its `mount`."""
    tree, entry = spec.tree, arguments.entry
    joints = tree.section("joints")
    at_parent = [] if arguments.parent.text in tree.section("links") else [*_joints_at(arguments.parent.text, joints)]
    if not at_parent:
        return MacroModule(spec, arguments.prefix)
    own = next((one for one in at_parent if one.name not in scan.joints), None)
    mount = YamlMap({one.name: YamlEntry(one.key, _without_ends(one.value)) for one in at_parent}, tree.span)
    others = YamlMap({name: one for name, one in joints.items() if one not in at_parent}, tree.span)
    tree = tree.with_value("joints", others) if others.entries else tree.without("joints")
    spec = replace(spec, tree=tree.with_value("mount", mount))
    parent = None if entry.parent else arguments.parent if arguments.parent.text != _STAND_IN else None
    if own is None:
        return MacroModule(spec, arguments.prefix, parent)
    if entry.origin is not None:
        note = Note("this joint attaches it", own.key.span)
        report = MACRO_PLACES_ITSELF.at(entry.origin.span, macro=arguments.macro.name, name=entry.name, notes=[note])
        arguments.sink.report(report)
    origin = own.value.get("origin") if isinstance(own.value, YamlMap) else None
    return MacroModule(spec, arguments.prefix, parent, origin)


def _joints_at(parent: str, joints: Mapping[str, YamlEntry]) -> Iterable[YamlEntry]:
    return (one for one in joints.values() if isinstance(one.value, YamlMap) and one.value.text("parent") == parent)


def _without_ends(joint: YamlNode) -> YamlNode:
    return joint.without("parent", "origin") if isinstance(joint, YamlMap) else joint
