"""Rename a part, or a name of expressions, in all specs of a workspace that use it, or refuse with the reason.

A module's link is renamed in the module and, with its prefixes, in the specs that use it. The result is compiled before
it is offered: the robots may differ in the name of the part only.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple

from lsprotocol import types
from lxml import etree

from linkforge_compile.analysis import Analysis, Settings, analyse_path
from linkforge_compile.diagnostics import Diagnostic, Severity
from linkforge_compile.formats.render import render, render_srdf, render_urdf
from linkforge_compile.lsp.convert import uri_of
from linkforge_compile.lsp.occurrence import Occurrence
from linkforge_compile.lsp.occurrences import Occurrences
from linkforge_compile.lsp.workspace import Document
from linkforge_compile.roots import identity
from linkforge_compile.source import Position, SourceFile, Span
from linkforge_compile.syntax import has_expression

_PLAIN_NAME = re.compile(r"[^\s'\"$(){}\[\],:#&*!|>%@`]+")
"""A name that YAML reads the same with and without quotes, wherever it is written."""


_EXPRESSION_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")


class RefusedError(Exception):
    """A part cannot be renamed; the message has the reason."""


class Renaming(NamedTuple):
    """What is renamed: `name` is the part of the text that changes, at the end of what each occurrence writes.

    Only a suffix that a part has besides its declaration may follow, as in `deck_joint`, the joint of the frame `deck`.
    """

    kind: str
    name: str
    occurrences: tuple[Occurrence, ...]
    suffixes: Mapping[tuple[str, str, str], str]
    """Those of parts that have one, by what they name."""

    def suffix(self, one: Occurrence) -> str:
        return self.suffixes.get(one.named, "")

    def renamed(self, one: Occurrence, new: str) -> str:
        """Return the final name of an occurrence after the change."""
        suffix = self.suffix(one)
        return one.name.removesuffix(self.name + suffix) + new + suffix


def renamed_at(document: Document, at: Position) -> tuple[Span, Renaming] | None:
    """Return the text of the name at a position and what it names; None if no name of a part is there.

    Raises:
        RefusedError: the name cannot be changed where it is written.

    """
    if document.analysis and document.analysis.instance is None:
        raise RefusedError("the text cannot be read; mend it first")
    indexes = [Occurrences(analysis) for analysis in document.analyses]
    real = identity(document.path)
    here = next((found[0] for index in indexes if (found := index.at(real, at))), None)
    if here is None:
        return None
    found = tuple(_connected(indexes, here))
    declared = [one for one in found if one.is_declaration]
    if not declared:
        raise RefusedError(f"no spec declares the {here.kind} '{here.name}'")
    if here.kind == "module":
        _refuse_prefix(here, document.analyses)
    suffixes = {one.named: one.suffix for one in declared if one.suffix}
    own = [one for one in declared if one.named == here.named]
    renaming = Renaming(here.kind, min(map(_fixed_end, own), key=len), found, suffixes)
    return _unquoted(here.span), renaming


def rename(document: Document, at: Position, new: str, settings: Settings) -> types.WorkspaceEdit | None:
    """Return the edits that give the part at a position another name; None if there is no part.

    Raises:
        RefusedError: it cannot be renamed, or the robots would differ in more than the name.

    """
    target = renamed_at(document, at)
    if target is None:
        return None
    span, renaming = target
    edits = _places_by_file(renaming)
    local = _local_name(new, span.text or "", renaming)
    texts = {path: _edited(places[0].file, places, local) for path, places in edits.items()}
    if any(one.scope for one in renaming.occurrences) and not _EXPRESSION_NAME.fullmatch(local):
        raise RefusedError(f"'{local}' is no name that expressions can use: letters, digits and '_'")
    for analysis in document.analyses:
        for variant in _variants_of(analysis):
            _prove(analysis, renaming, local, settings._replace(variant=variant), texts)
    changes: dict[str, Sequence[types.TextEdit]] = {}
    for places in edits.values():
        if path := places[0].file.path:
            changes[uri_of(path)] = [types.TextEdit(document.columns.range(place), local) for place in places]
    return types.WorkspaceEdit(changes=changes)


def _refuse_prefix(module: Occurrence, analyses: Iterable[Analysis]) -> None:
    """Raise RefusedError for a module whose name is the prefix of the names in it."""
    uses = (use for analysis in analyses if analysis.instance for use in analysis.instance.with_modules)
    for use in uses:
        if use.entry and use.entry.key and use.entry.key.span == module.span and use.entry.node.child("prefix") is None:
            raise RefusedError(
                f"the names in module '{module.written}' begin with its name; to keep them, "
                f"write 'prefix: {module.written}_' in its entry first"
            )


def _local_name(new: str, text: str, renaming: Renaming) -> str:
    """Return what takes the place of the name in the text at the position, for which the user writes a new one."""
    before, _, after = text.rpartition(renaming.name)
    if not new.startswith(before):
        made = next((one for one in renaming.occurrences if one.is_declaration and _is_made(one)), None)
        if made and not has_expression(text):
            raise RefusedError(f"{_made(made)}; a new one must begin with '{before}'")
        raise RefusedError(f"the new name must begin with '{before}', the prefix of the module")
    if not new.endswith(after):
        raise RefusedError(f"the new name must end with '{after}', as the joint is named after its frame or module")
    local = new[len(before) : len(new) - len(after)]
    if not _PLAIN_NAME.fullmatch(local):
        raise RefusedError(f"'{new}' is no name that can be written without quotes")
    return local


def _places_by_file(renaming: Renaming) -> dict[str, list[Span]]:
    """Return where the name is written, each place once, by the real path of the file."""
    # Those with an expression first, since the reason of a refusal is there.
    spans = [_place_of(one, renaming) for one in sorted(renaming.occurrences, key=_is_made, reverse=True)]
    found: dict[str, dict[tuple[Position, Position], Span]] = {}
    for span in spans:
        if span.file.path:
            found.setdefault(identity(span.file.path), {}).setdefault((span.start, span.end), span)
    return {path: [*places.values()] for path, places in found.items()}


def _connected(indexes: Sequence[Occurrences], first: Occurrence) -> list[Occurrence]:
    """Return the occurrences of all parts that are renamed with one, since a place writes the names of both."""
    at_place: dict[str, list[tuple[int, Occurrence]]] = {}
    of_part: dict[tuple[int, tuple[str, str, str]], list[Occurrence]] = {}
    for number, index in enumerate(indexes):
        for one in index.all:
            at_place.setdefault(str(one.span), []).append((number, one))
            of_part.setdefault((number, one.named), []).append(one)
    found: dict[Occurrence, None] = {}
    reached, waiting = {str(first.span)}, [str(first.span)]
    while waiting:
        for number, one in at_place[waiting.pop()]:
            for other in of_part.pop((number, one.named), ()):
                found[other] = None
                if str(other.span) not in reached:
                    reached.add(str(other.span))
                    waiting.append(str(other.span))
    return list(found)


def _fixed_end(one: Occurrence) -> str:
    """Return what the text of a name writes after the last expression in it; RefusedError for nothing."""
    text = _unquoted(one.span).text or ""
    end = text.rpartition(")")[2] if has_expression(text) else text
    is_name = one.name.endswith(end + one.suffix) if has_expression(text) else text == one.written
    if one.span.file.is_xml:
        raise RefusedError(f"the {one.kind} '{one.name}' is written in {one.span.file.shown}, which is no spec")
    if not end or not is_name:
        raise _made(one)
    return end


def _place_of(one: Occurrence, renaming: Renaming) -> Span:
    """Return the place of the text that changes in an occurrence; RefusedError if no text there writes it."""
    after = "" if one.suffix else renaming.suffix(one)
    end = _fixed_end(one)
    if not end.endswith(renaming.name + after) or not one.name.endswith(renaming.name + renaming.suffix(one)):
        raise _made(one)
    span, length = _unquoted(one.span), len(renaming.name)
    return span.within(span.end_column - span.column - len(after) - length, length)


def _is_made(one: Occurrence) -> bool:
    return has_expression(one.span.text or "")


def _made(one: Occurrence) -> RefusedError:
    return RefusedError(f"the name '{one.name}' is made of '{_unquoted(one.span).text}' at {one.span}")


def _unquoted(span: Span) -> Span:
    """Return the place of a name without its quotes; a place over several lines as it is."""
    text = span.text or ""
    is_quoted = len(text) > 1 and text[0] == text[-1] and text[0] in "'\""
    return span.within(1, len(text) - 2) if is_quoted else span


def _edited(file: SourceFile, places: Iterable[Span], new: str) -> str:
    """Return the text of a file with a new name at some places."""
    lines = re.split(r"(\r\n|\n|\r)", file.counted)
    for place in sorted(places, key=lambda one: one.start, reverse=True):
        line = lines[2 * place.line - 2]
        lines[2 * place.line - 2] = line[: place.column - 1] + new + line[place.end_column - 1 :]
    return "".join(lines)


def _variants_of(analysis: Analysis) -> tuple[str | None, ...]:
    """Return with what a spec is compiled: the defaults of its parameters, and each of its variants."""
    return (None, *analysis.spec.tree.section("variants")) if analysis.spec else ()


def _prove(analysis: Analysis, renaming: Renaming, new: str, settings: Settings, texts: Mapping[str, str]) -> None:
    """Compile a spec with the edited texts; RefusedError unless its robot differs in the name only."""
    path = analysis.spec.file.path if analysis.spec else None
    if path is None:
        return
    own = frozenset(Occurrences(analysis).all)
    names = {one.named: renaming.renamed(one, new) for one in renaming.occurrences if one in own}
    taken = {one.named for one in own if one.is_declaration}
    for (kind, _, scope), name in names.items():
        if (kind, name, scope) in taken:
            raise RefusedError(f"there is a {kind} '{name}' already")
    before = analysis if settings.variant is None else analyse_path(path, settings)
    changed = analyse_path(path, settings._replace(buffers={**settings.buffers, **texts}))
    _refuse_new_errors(before, changed)
    documents = _documents(changed)
    others = {_in_documents(one.kind, one.name) for one in Occurrences(changed).all if not one.scope}
    parts = {(kind, old): name for (kind, old, scope), name in names.items() if not scope}
    finals = {_in_documents(kind, old): _in_documents(kind, name) for (kind, old), name in parts.items()}
    for name in finals:
        _refuse_left(name, documents, is_other=name in others)
    if _alike(_documents(before), finals) != _alike(documents, finals):
        raise RefusedError(f"the robot of {path} would differ in more than the name")


def _refuse_new_errors(before: Analysis, after: Analysis) -> None:
    """Raise RefusedError for a spec with errors, whose robot cannot be compared, and for errors of the new name."""
    if fault := _first_error(before):
        raise RefusedError(f"mend the errors first: {fault}")
    if fault := _first_error(after):
        raise RefusedError(f"the new name would break the robot: {fault}")


def _first_error(analysis: Analysis) -> Diagnostic | None:
    return next((one for one in analysis.compilation.diagnostics if one.severity is Severity.ERROR), None)


def _in_documents(kind: str, name: str) -> str:
    """Return a name as outputs write it: that of a state without its group."""
    return name.rpartition("/")[2] if kind == "state" else name


def _documents(analysis: Analysis) -> list[str]:
    """Return the URDF, SRDF and controllers of a robot; none for a spec with errors."""
    robot = analysis.compilation.robot
    if robot is None:
        return []
    return [render_urdf(robot), render_srdf(robot), *([render(robot, "ros2_controllers")] if robot.controllers else ())]


def _refuse_left(name: str, documents: Sequence[str], *, is_other: bool) -> None:
    """Raise RefusedError for a name that is left in text that plugins read; another part may have the name too."""
    word = re.compile(rf"(?<![\w/.-]){re.escape(name)}(?![\w/.-])")
    for document in documents[:2]:
        for element in etree.fromstring(document.encode()).iter(etree.Element):
            is_root = element.getparent() is None  # it has the name of the robot
            values = [str(value) for key, value in element.attrib.items() if key != "type" and not is_root]
            if any(word.search(value) and not (is_other and value == name) for value in (*values, element.text or "")):
                line = etree.tostring(element, encoding="unicode", with_tail=False).partition("\n")[0]
                raise RefusedError(f"'{name}' is in text that others read, which is not renamed: {line}")


def _alike(documents: Iterable[str], names: Mapping[str, str]) -> list[str]:
    """Return documents in which old and new names are the same."""
    if not names:
        return [*documents]
    alike = {name: old for old, new in names.items() for name in (old, new)}
    longest_first = sorted(map(re.escape, alike), key=len, reverse=True)
    pattern = re.compile(rf"(?<![\w/.-])(?:{'|'.join(longest_first)})(?![\w/.-])")
    return [pattern.sub(lambda found: alike[found[0]], text) for text in documents]
