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

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, NamedTuple

from linkforge_compile.diagnostics import Diagnostic, Diagnostics, Note
from linkforge_compile.diagnostics.codes.importing import (
    MACRO_ADDS_TO_PARENT,
    MACRO_BLOCK,
    MACRO_SETS_FIELD,
    MACRO_WITHOUT_LINKS,
    XACRO_ARGUMENT,
    XACRO_UNKNOWN_NAME,
)
from linkforge_compile.diagnostics.codes.model import WRONG_DIMENSION
from linkforge_compile.diagnostics.codes.modules import PARAMETER_NOT_SET, UNKNOWN_PARAMETER
from linkforge_compile.diagnostics.enumerations import listed
from linkforge_compile.diagnostics.suggest import nearest
from linkforge_compile.load.loader import ImportSite, Loader, SpecFile
from linkforge_compile.load.macro_roles import ORIGIN, MacroRoles, OwnParent, OwnPrefix, dimension_of
from linkforge_compile.load.xacro import XacroArgument, XacroUse, open_xacro
from linkforge_compile.load.xacro_library import Macro, MacroParameter, XacroLibrary, read_library
from linkforge_compile.source import SourceFile
from linkforge_compile.source.malformed_xml import find_xml_error
from linkforge_compile.source.xml_tree import parse_xml
from linkforge_compile.syntax import YamlNode, YamlScalar

if TYPE_CHECKING:
    from linkforge_compile.source import Span
    from linkforge_compile.source.xml_tree import XmlDocument

STAND_IN = "world"
"""The parent of a macro that is used without one."""

_IDENTITY = '<origin xyz="0 0 0" rpy="0 0 0" {}=""/>'
"""A block in place of which the entry has the origin; it has the mark of a place that is in no file."""

_POSE = "a place may be a map instead, '{xyz: [0, 0, 1 m], rpy: [0, 0, 90 deg]}'"


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

    `parent` is the link, not among its own, to which it attaches its joint, `is_stand_in` if nobody named one; `placed`
    are the names of the joints, there or further on, whose origin is that of the entry, None for all of them there.
    `origin` is the argument for the block that the entry's origin would be.
    """

    spec: SpecFile
    prefix: str
    parent: YamlScalar
    is_stand_in: bool
    placed: frozenset[str] | None
    origin: XacroArgument | None

    def is_placed(self, joint: str) -> bool:
        """Whether a joint to the parent has the origin of the entry."""
        return self.placed is None or joint in self.placed


def call_macro(use: XacroUse, entry: MacroEntry, loader: Loader, sink: Diagnostics) -> MacroResult | None:
    """Call a macro of a xacro file and read what it makes as a spec; None after a reported error.

    The arguments of the use are for the macro, and for the file. What is wrong inside is the macro's, so the call is
    where `macro` is.
    """
    from linkforge_compile.importers.xacro import MacroCall

    library = read_library(use.path, loader, sink, use.used) if use.arguments is not None else None
    macro = _find(entry.macro, library, sink) if library else None
    if library is None or macro is None:
        return None
    arguments = _Arguments(use.arguments or {}, entry, macro, library, sink)
    blocks = tuple(filter(None, map(arguments.block, macro.blocks)))
    arguments.require_all()
    arguments.require_dimensions()
    if arguments.is_faulty:
        return None
    values, maps = (
        {name: one.text for name, one in arguments.values.items() if one.is_expression is is_map}
        for is_map in (False, True)
    )
    call = MacroCall(macro.name, values, blocks, maps)
    scan = _Scan()
    site = ImportSite(use.used.text, entry.macro.span)
    use = replace(use, used=site, arguments=arguments.of_file, used_elsewhere=None, call=call)
    spec = open_xacro(use, loader, sink, scan.look_at)
    placed = None if arguments.is_placed_by_entry else frozenset(scan.joints)
    if spec is None:
        return None
    if spec.tree.entries.keys().isdisjoint(("links", "frames")):
        sink.report(MACRO_WITHOUT_LINKS.at(entry.macro.span, macro=macro.name))
        return None
    return MacroResult(spec, arguments.prefix, arguments.parent, arguments.is_stand_in, placed, arguments.origin)


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
    is_stand_in: bool = False
    """Whether that link is in place of one that nobody named."""
    is_placed_by_entry: bool = False
    """Whether the macro takes its place in the parameters of an `xyz` and an `rpy`, and the entry gives it instead."""

    def __post_init__(self) -> None:
        for name, argument in self.given.items():
            parameter = self.macro.parameter(name)
            if parameter and not parameter.block:
                self.values[name] = argument
            elif not parameter:
                self._give_to_file(name, argument)
        roles = MacroRoles(self.library)
        self._set_prefix(roles.prefix(self.macro))
        self._set_parent(roles.parent(self.macro))
        self._set_place(roles.place(self.macro))

    def _give_to_file(self, name: str, argument: XacroArgument) -> None:
        known = (*(one.name for one in self.macro.parameters), *self.library.arguments, *self.library.used)
        if name in known:
            self.of_file[name] = argument
            if argument.is_expression:
                self._report(XACRO_ARGUMENT.at(argument.where, name=name))
            return
        declared = Note(f"macro '{self.macro.name}' is declared here", self.macro.element.span)
        self._report(UNKNOWN_PARAMETER.at(argument.where, name=name, near=known, notes=[declared]))

    def _set_prefix(self, own: OwnPrefix | None) -> None:
        entry = self.entry
        if own is None or (own.is_name and entry.has_prefix and own.name in self.values):
            self.prefix = entry.prefix
        elif own.name in self.values:
            if entry.has_prefix:
                self._refuse(own.name, "prefix")
        elif entry.prefix or not own.is_name:
            text = entry.prefix.removesuffix("_") if own.adds_underscore else entry.prefix
            self.values[own.name] = XacroArgument(text, entry.macro.span)

    def _set_parent(self, own: OwnParent | None) -> None:
        entry, suffix = self.entry, own.suffix if own else ""
        given = self.values.get(own.name) if own else None
        self.is_stand_in = entry.parent is None and given is None
        self.parent = entry.parent or _scalar((given.text if given else STAND_IN) + suffix, entry.macro.span)
        if own is None:
            return
        where, text = self.parent.span, self.parent.text
        if given is None:
            self.values[own.name] = XacroArgument(text.removesuffix(suffix), where)
            if not text.endswith(suffix):
                facts = {"macro": self.macro.name, "parameter": own.name, "suffix": suffix, "found": text}
                self._report(MACRO_ADDS_TO_PARENT.at(where, notes=[], **facts))
        elif entry.parent is not None:
            self._refuse(own.name, "parent")
        else:
            self.parent = _scalar(text, given.where)

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
        if given.origin and parameter.block == "*":
            return given.origin
        elements, problem = _elements_in(given.text)
        if elements is None or (parameter.block == "*" and elements != 1):
            what = "one element" if parameter.block == "*" else "elements"
            found = "a map" if given.is_expression else given.text
            notes = [Note(_POSE)] if given.is_expression and parameter.block == "*" else []
            notes += [Note(f"it is not XML: {problem}")] if problem and "<" in given.text else []
            self._report(MACRO_BLOCK.at(given.where, name=parameter.name, what=what, found=found, notes=notes))
            return None
        return given.text if parameter.block == "*" else f"<block>{given.text}</block>"

    @property
    def origin(self) -> XacroArgument | None:
        """The argument for the block that the entry gives as its `origin`."""
        parameter = self.macro.parameter(ORIGIN)
        return self.given.get(ORIGIN) if parameter and parameter.block == "*" else None

    def require_dimensions(self) -> None:
        """Report the quantities that are not what the macro takes: to xacro, `3 kg` is 3, and so 3 metres of height."""
        for name, argument in self.values.items():
            found = dimension_of(name, self.macro) if argument.quantity else None
            if found and argument.quantity and argument.quantity.dimension is not found[0]:
                dimension, where = found
                notes = [Note("the macro writes it here", where)]
                facts = {"expected": dimension.words, "found": f"'{argument.quantity}'"}
                other = argument.quantity.dimension.words
                self._report(WRONG_DIMENSION.at(argument.where, field=f"'{name}'", other=other, notes=notes, **facts))

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


def _scalar(text: str, span: Span) -> YamlScalar:
    return YamlScalar(text, text, span)


def _elements_in(text: str) -> tuple[int | None, str]:
    """Return how many elements a text has, None if it has anything else, and what is wrong with its XML."""
    if fault := find_xml_error(f"{text}</block>", "<block>"):
        return None, (find_xml_error(text, "<block>") or fault).problem
    root = parse_xml(SourceFile("<block>", f"<block>{text}</block>")).root
    return None if root.text.strip() else len(root.children), ""


# What the call made


class _Scan:
    """Finds in the expanded document which joints have the block that stands for the entry's origin."""

    def __init__(self) -> None:
        self.joints: set[str] = set()

    def look_at(self, document: XmlDocument) -> None:
        from linkforge_compile.importers.xacro.process import MARK

        for joint in document.root.children:
            origins = [child for child in joint.children if child.tag == "origin"]
            if joint.tag == "joint" and any(one.get(MARK) == "" for one in origins):
                self.joints.add(joint.get("name") or "")
