"""Report why xacro failed, in the file at fault and in the terms of its author."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from linkforge_compile.diagnostics import Diagnostic, Diagnostics, Note
from linkforge_compile.diagnostics.codes.importing import (
    XACRO_ARGUMENT_TOO_EARLY,
    XACRO_FAILED,
    XACRO_FILE_MISSING,
    XACRO_NOT_INSTALLED,
    XACRO_UNKNOWN_NAME,
)
from linkforge_compile.diagnostics.codes.modules import PARAMETER_NOT_SET, UNKNOWN_PARAMETER
from linkforge_compile.expand.loader import ImportSite, Loader
from linkforge_compile.expand.packages import unknown_package
from linkforge_compile.expand.paths import as_typed, names_in
from linkforge_compile.expand.xacro_use import WrittenElements, XacroAnswers, XacroUse
from linkforge_compile.source import Span

if TYPE_CHECKING:
    from linkforge_compile.importers.xacro import Failed, Place
    from linkforge_compile.source.xml_tree import XmlElement

_MESSAGES = (
    (r"Undefined parameters \[(.*)\]", "the macro also takes {0}, which this call does not give"),
    (r'Invalid parameter "(.*)"', "the macro takes no '{0}'"),
    (r"Not enough blocks", "the macro takes a block more, an element inside of the call"),
    (r'Unused block "(.*)"', "the macro takes no block, found <{0}>"),
    (r'Undefined block "(.*)"', "no block of the macro is named '{0}'"),
    (r'Xacro conditional "(.*)" evaluated to "(.*)", which.*', "the condition is true or false, found '{1}'"),
    (r"unsupported operand type\(s\) for (\S+).*: .*'str'.*", "'{0}' takes numbers, found a text"),
    (r"can't multiply sequence by non-int of type 'float'", "'*' takes numbers, found a text"),
    (r"environment variable '(.*)' is not set", "the environment variable {0} is not set"),
    (
        r"Unknown substitution command \[(.*?)\].*",
        "'$({0})' is none of $(arg), $(find), $(dirname), $(env), $(optenv)",
    ),
    (r"xacro:(\w+): missing attribute '(\w+)'", "<xacro:{0}> has no attribute '{1}'"),
)
"""Patterns of xacro's messages and our wording; other messages are shown as they are."""


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
        else:
            self.inside.report(self._fault(failed, failed.reason, place))

    def report_unknown_arguments(self, declared: Mapping[str, Place], wanted: Collection[str]) -> None:
        """Report the arguments that neither this file nor the robot's other file declares or uses."""
        if self.use.used_elsewhere is None:
            return
        first = next((self._declaration(declared, name) for name in declared), None)
        note = Note("its arguments are declared here" if declared else "this file declares no arguments", first)
        known = (*declared, *wanted, *self.use.used_elsewhere)
        for name, entry in self.use.arguments.entries.items():
            if name not in known:
                self.sink.report(UNKNOWN_PARAMETER.at(entry.key.span, name=name, near=known, notes=[note]))

    def _unknown_package(self, name: str, place: Span | None) -> Diagnostic:
        where, loader = self.use.used.where, self.loader
        near = {**(self.use.packages or {}), **loader.packages}
        notes = [Note("it is looked for here", place)] if where and place else []
        start, nearby = self.use.path.parent, loader.nearby_packages
        return unknown_package(where or place, name, start, loader.roots, nearby, near=near, notes=notes)

    def _report_unset(self, name: str, place: Span | None, arguments: Mapping[str, Place]) -> None:
        where, declared = self.use.used.where, self._declaration(arguments, name)
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
        if failed.kind == "NameError" and (unknown := re.search(r"'(\w+)'", reason)):
            kind, near_names = "property or parameter", self._names()
            return XACRO_UNKNOWN_NAME.at(where, kind=kind, name=unknown[1], near=near_names, notes=notes)
        if unknown := re.match(r"unknown macro name: (?:xacro:)?(\S+)", reason):
            macros = self.written.named("xacro:macro")
            return XACRO_UNKNOWN_NAME.at(where, kind="macro", name=unknown[1], near=macros, notes=notes)
        within = f", in '${{{failed.expressions[-1]}}}'" if failed.expressions else ""
        return XACRO_FAILED.at(where, problem=_message(reason, failed.kind) + within, notes=notes)

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

    def _declaration(self, declared: Mapping[str, Place], name: str) -> Span | None:
        element = self.written.element(declared[name]) if name in declared else None
        return element.span if element else None

    def _place(self, failed: Failed) -> Span | None:
        if failed.line is not None and failed.file:
            file = self.written.open(failed.file)
            return Span(file, failed.line, 1, failed.line, 1) if file else None
        element = self.written.element(failed.place) if failed.place else None
        return element.span if element else None


def _find_expression(expression: str, elements: Iterable[XmlElement]) -> Span | None:
    """Return the span of the first attribute in which an expression is written."""
    text = f"${{{expression}}}"
    found = ((element, name) for element in elements for name, value in element.values.items() if text in value)
    return next((element.attributes[name].span for element, name in found), None)


def _message(reason: str, kind: str) -> str:
    line = " ".join(reason.split())
    for pattern, words in _MESSAGES:
        if found := re.fullmatch(pattern, line):
            return words.format(*found.groups())
    return f"there is no key {line}" if kind == "KeyError" else line
