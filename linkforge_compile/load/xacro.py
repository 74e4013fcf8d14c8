"""Expand xacro files, read the results as specs, and report faults where they were written."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

from linkforge_compile.diagnostics import Diagnostic, Diagnostics, Note
from linkforge_compile.diagnostics.codes.importing import (
    MACRO_WITHOUT_LINKS,
    MACROS_ONLY,
    NOTHING_EXPANDED,
    XACRO_ARGUMENT_TOO_EARLY,
    XACRO_FAILED,
    XACRO_FILE_MISSING,
    XACRO_FORBIDDEN,
    XACRO_NOT_INSTALLED,
    XACRO_UNKNOWN_NAME,
    XACRO_WARNS,
)
from linkforge_compile.diagnostics.codes.modules import PARAMETER_NOT_SET, UNKNOWN_PARAMETER
from linkforge_compile.diagnostics.enumerations import listed
from linkforge_compile.load.loader import ImportSite, Loader, SpecFile, with_use_trace
from linkforge_compile.load.xacro_library import XacroLibrary, read_library
from linkforge_compile.load.xacro_written import WrittenElements
from linkforge_compile.paths import Package, as_typed, find_package, names_in, unknown_package
from linkforge_compile.roots import exists
from linkforge_compile.source import SourceFile, Span

if TYPE_CHECKING:
    from linkforge_compile.importers.document import Imported, Move
    from linkforge_compile.importers.package_paths import PackagePaths
    from linkforge_compile.importers.xacro import Failed, MacroCall, Place, XacroAnswers
    from linkforge_compile.source.xml_tree import XmlDocument, XmlElement
    from linkforge_compile.units import Quantity

Look: TypeAlias = "Callable[[XmlDocument], None]"
"""Sees an expanded document."""

_IN_NO_FILE_OF_MACRO = (
    "if another file defines it, which robots include before this one: write a xacro that includes both files, "
    "and use the macro from that"
)

FORBIDDEN = "LINKFORGE_NO_XACRO"
"""The environment variable that, set to anything, forbids expanding xacro files."""


class Expansion(NamedTuple):
    """The text of a xacro file as expanded, or that of another XML file.

    `files` are the files in which its elements were written, the named one first, and the text itself; `moved` gives
    them their places there, None if they stay where they are. `arguments` are the names of those that the file uses.
    """

    text: SourceFile
    files: tuple[SourceFile, ...]
    moved: Move | None = None
    arguments: frozenset[str] = frozenset()
    packages: Mapping[str, Path] = MappingProxyType({})
    """The folders that `$(find ...)` gave, by package."""


def open_xacro(use: XacroUse, loader: Loader, sink: Diagnostics, look: Look | None = None) -> SpecFile | None:
    """Expand a xacro file and read it as a spec; None after a reported error.

    `look` sees the expanded document with the marks of places.
    """
    robot = read_xacro(use, loader, sink, look=look)
    if robot is None:
        return None
    (main, *others), imported = robot
    tree, folder = imported.tree, use.path.parent
    included = {file: SpecFile(file, tree, folder, use.package) for file in others}
    return SpecFile(main, tree, folder, use.package, included, use.packages, imported.renamed)


def read_xacro(
    use: XacroUse,
    loader: Loader,
    sink: Diagnostics,
    *,
    keeps_refused: bool = False,
    spec_folder: Path | None = None,
    look: Look | None = None,
) -> tuple[tuple[SourceFile, ...], Imported] | None:
    """Expand a xacro file and read the robot; `keeps_refused` as in `read_urdf`. None after a reported error.

    Returns the files in which the robot was written, the named one first, and the robot. For a spec in `spec_folder`,
    paths in packages become expressions; None for no spec.
    """
    from linkforge_compile.importers.package_paths import NO_PACKAGE_PATHS
    from linkforge_compile.importers.urdf import read_urdf

    expansion = expand_xacro(use, loader, sink)
    if expansion is None:
        return None
    inside = with_use_trace(sink, (use.used.where,))
    paths = NO_PACKAGE_PATHS
    if spec_folder:
        paths = _package_paths(expansion, spec_folder, loader)
        # What the spec finds elsewhere is no loss, so its own check finds what xacro found.
        loader.packages = {**expansion.packages, **loader.packages}

    def moved(document: XmlDocument) -> XmlDocument:
        if look:
            look(document)
        return expansion.moved(document) if expansion.moved else document

    faults = Diagnostics()
    imported = read_urdf(expansion.text, faults, moved, keeps_refused=keeps_refused, package_paths=paths)
    if NOTHING_EXPANDED in {one.code for one in faults} and (library := read_library(use.path, loader, Diagnostics())):
        _report_macros_only(use, library, expansion, sink)
    else:
        inside.report_all(faults)
    return (expansion.files, imported) if imported else None


def _report_macros_only(use: XacroUse, library: XacroLibrary, expansion: Expansion, sink: Diagnostics) -> None:
    macros, where = library.macros, use.used.where or expansion.files[0].whole
    if use.call or not macros:
        nothing = MACRO_WITHOUT_LINKS.at(where, macro=use.call.macro) if use.call else NOTHING_EXPANDED.at(where)
        sink.report(nothing)
        return
    # Others, such as those of an inertia, are for these to call.
    making = next(
        (name for name, one in macros.items() if any(part.tag == "link" for part in one.element.walk())), None
    )
    notes = [Note(f"its macros are {listed([*macros], 'and')}")] if len(macros) > 1 else []
    sink.report(MACROS_ONLY.at(where, path=use.used.text, macro=making or next(iter(macros)), notes=notes))


def _package_paths(expansion: Expansion, spec_folder: Path, loader: Loader) -> PackagePaths:
    from linkforge_compile.importers.package_paths import FoundPackage, PackagePaths

    roots = loader.roots
    found = {
        str(folder): FoundPackage(name, find_package(name, {}, spec_folder, roots))
        for name, folder in expansion.packages.items()
    }
    return PackagePaths(found, lambda file: roots.hold(file) and exists(file))


def expand_xacro(use: XacroUse, loader: Loader, sink: Diagnostics) -> Expansion | None:
    """Expand a xacro file with any content; None after a reported error."""
    from linkforge_compile.importers.xacro import Failed, XacroAnswers, moved_back, run_xacro

    main = loader.open_xml(use.path, sink, use.used)
    if main is None or use.arguments is None:
        return None
    arguments = {name: argument.text for name, argument in use.arguments.items()}
    if os.environ.get(FORBIDDEN) or not loader.runs_xacro:
        sink.report(XACRO_FORBIDDEN.at(use.used.where, path=use.used.text, variable=FORBIDDEN))
        return None
    answers = XacroAnswers(use.path, {**use.packages, **loader.packages}, loader.roots)
    result = run_xacro(use.path, arguments, answers, use.call)
    while isinstance(result, Failed) and result.missing and answers.change_package(result.missing):
        result = run_xacro(use.path, arguments, answers, use.call)
    written = WrittenElements(result, main, loader)
    inside = with_use_trace(sink, (use.used.where,))
    reporter = XacroReporter(use, written, loader, sink, inside)
    if isinstance(result, Failed):
        reporter.report_failure(result, answers)
        return None
    reporter.report_unknown_arguments(result.arguments, result.wanted)
    for warning in result.warnings:
        inside.report(XACRO_WARNS.at(main.whole, text=warning))
    expanded = SourceFile(f"{main.name} (expanded)", result.text, order=main.order)
    files = (main, *written.files, expanded)
    moved = partial(moved_back, find=written.element)
    return Expansion(expanded, files, moved, frozenset((*result.arguments, *result.wanted)), answers.packages)


class XacroArgument(NamedTuple):
    """An argument and the place of its name; for a macro it may be the expression of a map, also as an `<origin>`.

    `quantity` is what was written with a unit.
    """

    text: str
    where: Span
    is_expression: bool = False
    origin: str | None = None
    quantity: Quantity | None = None


@dataclass(frozen=True)
class XacroUse:
    """What names a xacro file, its arguments, and the package folders that the using file declares.

    `arguments` is None if some are faulty, which is reported. `package` is the one through whose `package://` the file
    was reached. `used_elsewhere` are the arguments that the robot's other file uses; None if that file reports the
    unknown ones. With a `call`, the robot is what a macro of the file makes.
    """

    path: Path
    used: ImportSite
    arguments: Mapping[str, XacroArgument] | None = field(default_factory=dict)
    packages: Mapping[str, Path] = field(default_factory=dict)
    package: Package | None = None
    used_elsewhere: Collection[str] | None = ()
    call: MacroCall | None = None


@dataclass(frozen=True)
class XacroReporter:
    """Reports faults of one use of a xacro file: to `sink` at the use, to `inside` in the file, with a note."""

    use: XacroUse
    written: WrittenElements
    loader: Loader
    sink: Diagnostics
    inside: Diagnostics

    def report_failure(self, failed: Failed, answers: XacroAnswers) -> None:
        where = self.use.used.where
        if failed.reason is None:
            self.sink.report(XACRO_NOT_INSTALLED.at(where, path=self.use.used.text))
            return
        self.report_unknown_arguments(failed.arguments or {}, failed.wanted)
        place = self._place(failed)
        if answers.refused:
            path, reader = answers.refused[-1], place or where or self.written.main.whole
            self.loader.may_read(path, ImportSite(str(as_typed(path)), reader), self.inside)
        elif answers.missing_packages:
            self.sink.report(self._unknown_package(answers.missing_packages[-1], place))
        elif failed.kind == "ArgException":
            self._report_unset(failed.reason, place, failed.arguments or {})
        elif self.use.call and (unset := re.fullmatch(r"Undefined property to forward: (\w+)", failed.reason)):
            self.sink.report(self._unset_of_macro(unset[1], self.use.call.macro))
        else:
            self.inside.report(self._fault(failed, failed.reason, place))

    def report_unknown_arguments(self, declared: Mapping[str, Place], wanted: Collection[str]) -> None:
        """Report the arguments that neither this file nor the robot's other file declares or uses."""
        if self.use.used_elsewhere is None:
            return
        first = next(map(self.written.span, declared.values()), None)
        note = Note("its arguments are declared here" if declared else "this file declares no arguments", first)
        known = (*declared, *wanted, *self.use.used_elsewhere)
        for name, argument in (self.use.arguments or {}).items():
            if name not in known:
                self.sink.report(UNKNOWN_PARAMETER.at(argument.where, name=name, near=known, notes=[note]))

    def _unknown_package(self, name: str, place: Span | None) -> Diagnostic:
        where, loader = self.use.used.where, self.loader
        near = {**self.use.packages, **loader.packages}
        notes = [Note("it is looked for here", place)] if where and place else []
        start, nearby = self.use.path.parent, loader.nearby_packages
        return unknown_package(where or place, name, start, loader.roots, nearby, near=near, notes=notes)

    def _report_unset(self, name: str, place: Span | None, arguments: Mapping[str, Place]) -> None:
        where, declared = self.use.used.where, self.written.span(arguments.get(name))
        remedy = f"with: {{{name}: VALUE}}" if where else f"{name}:=VALUE"
        if declared and place:
            notes = [Note("its default is here", declared)]
            self.inside.report(XACRO_ARGUMENT_TOO_EARLY.at(place, name=name, remedy=remedy, notes=notes))
        else:
            what = f"parameter '{name}' has"
            self.sink.report(PARAMETER_NOT_SET.at(where or place, what=what, remedy=f"'{remedy}'"))

    def _fault(self, failed: Failed, reason: str, place: Span | None) -> Diagnostic:
        """Return the diagnostic for a failed expression or element."""
        where, notes = self._where(failed, place)
        if failed.missing:
            name, near = failed.missing.name, names_in(failed.missing.parent)
            return XACRO_FILE_MISSING.at(where, path=as_typed(failed.missing), name=name, near=near, notes=notes)
        elsewhere = [Note(_IN_NO_FILE_OF_MACRO)] if self.use.call else []
        if failed.kind == "NameError" and (unknown := re.search(r"'(\w+)'", reason)):
            kind, near_names = "property or parameter", self._names()
            return XACRO_UNKNOWN_NAME.at(where, kind=kind, name=unknown[1], near=near_names, notes=[*notes, *elsewhere])
        if unknown := re.match(r"unknown macro name: (?:xacro:)?(\S+)", reason):
            macros = self.written.named("xacro:macro")
            return XACRO_UNKNOWN_NAME.at(where, kind="macro", name=unknown[1], near=macros, notes=[*notes, *elsewhere])
        from linkforge_compile.importers.xacro import plain_message

        within = f", in '${{{failed.expressions[-1]}}}'" if failed.expressions else ""
        return XACRO_FAILED.at(where, problem=plain_message(reason, failed.kind) + within, notes=notes)

    def _unset_of_macro(self, parameter: str, name: str) -> Diagnostic:
        """Return the report of a parameter of a macro that takes the value around its call, where there is none."""
        macros = (one for one in self.written.all_elements if one.tag == "xacro:macro" and one.get("name") == name)
        notes = [
            Note(f"'{parameter}:=^' takes the value around the call, and there is none", one.span) for one in macros
        ]
        what, remedy = f"parameter '{parameter}' of macro '{name}' has", f"'with: {{{parameter}: VALUE}}'"
        return PARAMETER_NOT_SET.at(self.use.used.where, what=what, remedy=remedy, notes=notes)

    def _where(self, failed: Failed, place: Span | None) -> tuple[Span | None, list[Note]]:
        """Return where the failed expression is written, with a note on what needs it if that is elsewhere."""
        where = place or self.use.used.where
        if not failed.expressions:
            return where, []
        innermost = failed.expressions[-1]
        if stopped := self.written.element(failed.place) if failed.place else None:
            own = _find_expression(innermost, [stopped])
            if own or f"${{{innermost}}}" in stopped.raw:
                return own or where, []
        cause = _find_expression(innermost, self.written.all_elements)
        return (cause, [Note("it is needed here", where)]) if cause else (where, [])

    def _names(self) -> Iterator[str]:
        """Yield the names of properties and of macro parameters."""
        yield from self.written.named("xacro:property")
        for element in self.written.all_elements:
            if element.tag == "xacro:macro":
                yield from re.findall(r"(?:^|\s)[*^]*([A-Za-z_]\w*)", element.get("params") or "")

    def _place(self, failed: Failed) -> Span | None:
        if failed.line is not None and failed.file:
            file = self.written.open(failed.file)
            return Span(file, failed.line, 1, failed.line, 1) if file else None
        return self.written.span(failed.place)


def _find_expression(expression: str, elements: Iterable[XmlElement]) -> Span | None:
    """Return the span of the first attribute in which an expression is written."""
    text = f"${{{expression}}}"
    found = ((element, name) for element in elements for name, value in element.values.items() if text in value)
    return next((element.attributes[name].span for element, name in found), None)
