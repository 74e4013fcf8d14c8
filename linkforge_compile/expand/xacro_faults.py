"""What xacro cannot do, told in the file and the words of whoever wrote it."""

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
from linkforge_compile.expand.loader import Loader, Used
from linkforge_compile.expand.packages import unknown_package
from linkforge_compile.expand.paths import as_typed, names_in
from linkforge_compile.source import SourceFile, Span

if TYPE_CHECKING:
    from pathlib import Path

    from linkforge_compile.expand.xacro import Asked, XacroUse
    from linkforge_compile.importers.xacro import Expanded, Failed, Place
    from linkforge_compile.source.xml_tree import XmlElement


class Written:
    """The elements of xacro files as they were written, each file read when it is first asked for."""

    def __init__(self, result: Expanded | Failed, main: SourceFile, loader: Loader) -> None:
        self.main, self._loader = main, loader
        self._paths = result.files
        self._elements: dict[int, tuple[XmlElement, ...]] = {}
        files = (self.open(path) for path in result.files[1:])
        self.files = tuple(file for file in files if file)
        for path in result.read:
            loader.note_read(path)

    def element(self, place: Place) -> XmlElement | None:
        elements = self._elements_of(place.file)
        return elements[place.element] if place.element < len(elements) else None

    @property
    def all_elements(self) -> Iterator[XmlElement]:
        return (element for number in range(len(self._paths)) for element in self._elements_of(number))

    def named(self, tag: str) -> Iterator[str]:
        """Yield the names of all elements of a tag of xacro's."""
        return (name for one in self.all_elements if one.tag == tag and (name := one.get("name")))

    def open(self, path: Path) -> SourceFile | None:
        """Read one of the others, which the first names, so that it is no word of the user's."""
        return self._loader.open_xml(path, Diagnostics(), Used(str(path), self.main.whole))

    def _elements_of(self, number: int) -> tuple[XmlElement, ...]:
        if number not in self._elements:
            self._elements[number] = self._read(number)
        return self._elements[number]

    def _read(self, number: int) -> tuple[XmlElement, ...]:
        from linkforge_compile.importers.xml import read_xml

        file = self.main if number == 0 else self.open(self._paths[number])
        document = read_xml(file, Diagnostics()) if file else None
        return tuple(in_order(document.root)) if document else ()


@dataclass(frozen=True)
class Telling:
    """Tells what is wrong with a use of a xacro file: `sink` at the use, `inside` in the file with its use."""

    use: XacroUse
    written: Written
    loader: Loader
    sink: Diagnostics
    inside: Diagnostics

    def failed(self, failed: Failed, asked: Asked) -> None:
        where = self.use.used.where
        if failed.reason is None:
            self.sink.report(XACRO_NOT_INSTALLED.at(where, path=self.use.used.text))
            return
        self.unknown_arguments(failed.arguments or {}, failed.wanted)
        place = self._place(failed)
        if asked.refused:
            path, writer = asked.refused[-1], place or where or self.written.main.whole
            self.loader.may_read(path, Used(str(as_typed(path)), writer), self.inside)
        elif asked.lost:
            near = {**(self.use.packages or {}), **self.loader.packages}
            name = asked.lost[-1]
            looked = [Note("it is looked for here", place)] if where and place else []
            folder = self.use.path.parent
            self.sink.report(unknown_package(where or place, name, folder, self.loader, near=near, notes=looked))
        elif failed.kind == "ArgException":
            self._unset(failed.reason, place, failed.arguments or {})
        else:
            self.inside.report(self._fault(failed, failed.reason, place))

    def _unset(self, name: str, place: Span | None, arguments: Mapping[str, Place]) -> None:
        where, declared = self.use.used.where, self._declared(arguments, name)
        remedy = f"with: {{{name}: VALUE}}" if where else f"{name}:=VALUE"
        if declared and place:
            notes = [Note("its default is here", declared)]
            self.inside.report(XACRO_ARGUMENT_TOO_EARLY.at(place, name=name, remedy=remedy, notes=notes))
        else:
            what = f"parameter '{name}' has"
            self.sink.report(PARAMETER_NOT_SET.at(where or place, what=what, remedy=f"'{remedy}'"))

    def _where(self, failed: Failed, place: Span | None) -> tuple[Span | None, list[Note]]:
        """Return where the expression at fault is written; if that is elsewhere, with the place that needs it."""
        where = place or self.use.used.where
        if not failed.expressions:
            return where, []
        innermost = failed.expressions[-1]
        if stopped := self.written.element(failed.place) if failed.place else None:
            own = self._expression(innermost, [stopped])
            if own or f"${{{innermost}}}" in stopped.raw:
                return own or where, []
        cause = self._expression(innermost, self.written.all_elements)
        return (cause, [Note("it is needed here", where)]) if cause else (where, [])

    def _fault(self, failed: Failed, reason: str, place: Span | None) -> Diagnostic:
        """Return what xacro could not do, at the expression at fault."""
        where, notes = self._where(failed, place)
        if failed.missing:
            name, near = failed.missing.name, names_in(failed.missing.parent)
            return XACRO_FILE_MISSING.at(where, path=as_typed(failed.missing), name=name, near=near, notes=notes)
        if failed.kind == "NameError" and (unknown := re.search(r"'(\w+)'", reason)):
            return XACRO_UNKNOWN_NAME.at(
                where, kind="property or parameter", name=unknown[1], near=self._names(), notes=notes
            )
        if unknown := re.match(r"unknown macro name: (?:xacro:)?(\S+)", reason):
            return XACRO_UNKNOWN_NAME.at(
                where, kind="macro", name=unknown[1], near=self.written.named("xacro:macro"), notes=notes
            )
        within = f", in '${{{failed.expressions[-1]}}}'" if failed.expressions else ""
        return XACRO_FAILED.at(where, problem=_in_our_words(reason, failed.kind) + within, notes=notes)

    def _names(self) -> Iterator[str]:
        """Yield the names of properties, and of parameters of macros."""
        yield from self.written.named("xacro:property")
        for element in self.written.all_elements:
            if element.tag == "xacro:macro":
                yield from re.findall(r"(?:^|\s)[*^]*([A-Za-z_]\w*)", element.get("params") or "")

    @staticmethod
    def _expression(expression: str, elements: Iterable[XmlElement]) -> Span | None:
        """Return the first attribute of elements in which an expression is written."""
        said = f"${{{expression}}}"
        found = ((element, name) for element in elements for name, value in element.values.items() if said in value)
        return next((element.attributes[name].span for element, name in found), None)

    def unknown_arguments(self, declared: Mapping[str, Place], wanted: Collection[str]) -> None:
        """Report the arguments that the file neither declares nor wants, unless another file of the robot does."""
        if self.use.taken is None:
            return
        first = next((self._declared(declared, name) for name in declared), None)
        note = Note("its arguments are declared here" if declared else "this file declares no arguments", first)
        for name, entry in self.use.arguments.entries.items():
            if name not in (known := (*declared, *wanted, *self.use.taken)):
                self.sink.report(UNKNOWN_PARAMETER.at(entry.key.span, name=name, near=known, notes=[note]))

    def _declared(self, declared: Mapping[str, Place], name: str) -> Span | None:
        element = self.written.element(declared[name]) if name in declared else None
        return element.span if element else None

    def _place(self, failed: Failed) -> Span | None:
        if failed.line is not None and failed.file:
            file = self.written.open(failed.file)
            return Span(file, failed.line, 1, failed.line, 1) if file else None
        element = self.written.element(failed.place) if failed.place else None
        return element.span if element else None


def in_order(element: XmlElement) -> list[XmlElement]:
    """Return an element and all in it in the order of the document, as xacro's parser counts them."""
    return [element, *(inner for child in element.children for inner in in_order(child))]


_OUR_WORDS = (
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
"""What xacro says, as a pattern, and how it is told; what is in neither is told as it is."""


def _in_our_words(reason: str, kind: str) -> str:
    line = " ".join(reason.split())
    for pattern, words in _OUR_WORDS:
        if found := re.fullmatch(pattern, line):
            return words.format(*found.groups())
    return f"there is no key {line}" if kind == "KeyError" else line
