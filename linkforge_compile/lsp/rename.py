"""Rename a part in all specs of a workspace that name it, or refuse with the reason.

A module's link is renamed in the module and, with its prefixes, in the specs that use it. The result is compiled before
it is offered: the robots may differ in the name only.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple

from lsprotocol import types

from linkforge_compile.analysis import Analysis, Settings, analyse_path
from linkforge_compile.diagnostics import Severity
from linkforge_compile.formats.render import render_srdf, render_urdf
from linkforge_compile.lsp.convert import uri_of
from linkforge_compile.lsp.occurrences import Occurrence, Occurrences
from linkforge_compile.lsp.workspace import Document
from linkforge_compile.roots import identity
from linkforge_compile.source import Position, SourceFile, Span

_PLAIN_NAME = re.compile(r"[^\s'\"$(){}\[\],:#&*!|>%@`]+")
"""A name that YAML reads the same with and without quotes, wherever it is written."""


class RefusedError(Exception):
    """A part cannot be renamed; the message has the reason."""


class Renaming(NamedTuple):
    """What is renamed: every occurrence of some parts, whose names end with `name` as their declaration writes it."""

    kind: str
    name: str
    occurrences: tuple[Occurrence, ...]


def renamed_at(document: Document, at: Position) -> tuple[Span, Renaming] | None:
    """Return the text of the name at a position and what it names; None if no name of a part is there.

    Raises:
        RefusedError: the name cannot be changed where it is written.

    """
    indexes = [Occurrences(analysis) for analysis in document.analyses]
    real = identity(document.path)
    here = next((found[0] for index in indexes if (found := index.at(real, at))), None)
    if here is None:
        return None
    found = tuple(_connected(indexes, here))
    declared = [one for one in found if one.is_declaration]
    if not declared:
        raise RefusedError(f"no spec declares the {here.kind} '{here.name}'")
    renaming = Renaming(here.kind, min((one.written for one in declared), key=len), found)
    return _text_of(here, renaming), renaming


def rename(document: Document, at: Position, new: str, settings: Settings) -> types.WorkspaceEdit | None:
    """Return the edits that give the part at a position another name; None if there is no part.

    Raises:
        RefusedError: it cannot be renamed, or the robots would differ in more than the name.

    """
    target = renamed_at(document, at)
    if target is None:
        return None
    span, renaming = target
    local = _local_name(new, (span.text or "").removesuffix(renaming.name))
    edits = _places_by_file(renaming)
    texts = {path: _edited(places[0].file, places, renaming.name, local) for path, places in edits.items()}
    _prove(document.analyses, renaming, local, settings._replace(buffers={**settings.buffers, **texts}))
    changes: dict[str, Sequence[types.TextEdit]] = {}
    for places in edits.values():
        if path := places[0].file.path:
            changes[uri_of(path)] = [_edit(document, place, renaming.name, local) for place in places]
    return types.WorkspaceEdit(changes=changes)


def _local_name(new: str, prefix: str) -> str:
    """Return a new name without the prefix that it has where the user writes it."""
    if not new.startswith(prefix):
        raise RefusedError(f"the new name must begin with '{prefix}', the prefix of the module")
    local = new.removeprefix(prefix)
    if not _PLAIN_NAME.fullmatch(local):
        raise RefusedError(f"'{new}' is no name that can be written without quotes")
    return local


def _places_by_file(renaming: Renaming) -> dict[str, list[Span]]:
    """Return where the name is written, each place once, by the real path of the file."""
    spans = (_text_of(one, renaming) for one in renaming.occurrences)
    found: dict[str, list[Span]] = {}
    for span in {(str(span), span.end): span for span in spans if span.file.path}.values():
        found.setdefault(identity(span.file.path or ""), []).append(span)
    return found


def _connected(indexes: Sequence[Occurrences], first: Occurrence) -> list[Occurrence]:
    """Return the occurrences of all parts that are renamed with one, since a place writes the names of both."""
    places: set[tuple[str, str]] = {(first.kind, str(first.span))}
    found: dict[Occurrence, None] = {}
    is_growing = True
    while is_growing:
        named = {
            (number, one.kind, one.name)
            for number, index in enumerate(indexes)
            for one in index.all
            if (one.kind, str(one.span)) in places
        }
        found = {
            one: None
            for number, index in enumerate(indexes)
            for one in index.all
            if (number, one.kind, one.name) in named
        }
        reached = {(one.kind, str(one.span)) for one in found}
        is_growing = bool(reached - places)
        places |= reached
    return list(found)


def _text_of(one: Occurrence, renaming: Renaming) -> Span:
    """Return the place of the name without quotes; RefusedError if no text there writes it."""
    text, place = one.span.text or "", f"{one.span.file.shown}:{one.span.line}:{one.span.column}"
    if one.span.file.is_xml:
        raise RefusedError(f"the {one.kind} '{one.name}' is written in {one.span.file.shown}, which is no spec")
    quote = text[:1] if text[:1] in {"'", '"'} else ""
    inside = text.removeprefix(quote).removesuffix(quote)
    if inside != one.written or not inside.endswith(renaming.name):
        raise RefusedError(f"the name '{one.name}' is made of '{text}' at {place}")
    return one.span.within(len(quote), len(inside))


def _edited(file: SourceFile, places: Iterable[Span], old: str, new: str) -> str:
    """Return the text of a file with the names at some places renamed."""
    lines = re.split(r"(\r\n|\n|\r)", file.counted)
    for place in sorted(places, key=lambda one: one.start, reverse=True):
        line, end = lines[2 * place.line - 2], place.end_column - 1
        lines[2 * place.line - 2] = line[: end - len(old)] + new + line[end:]
    return "".join(lines)


def _edit(document: Document, place: Span, old: str, new: str) -> types.TextEdit:
    end = place._replace(column=place.end_column - len(old))
    return types.TextEdit(document.columns.range(end), new)


def _prove(analyses: Iterable[Analysis], renaming: Renaming, new: str, settings: Settings) -> None:
    """Compile each spec with the edits; RefusedError unless its robot differs in the name only."""
    for analysis in analyses:
        path = analysis.spec.file.path if analysis.spec else None
        if path is None:
            continue
        names = {one.name: one.name.removesuffix(renaming.name) + new for one in renaming.occurrences}
        taken = {(one.kind, one.name) for one in Occurrences(analysis).all if one.is_declaration}
        if clash := next((name for name in names.values() if (renaming.kind, name) in taken), None):
            raise RefusedError(f"there is a {renaming.kind} '{clash}' already")
        changed = analyse_path(path, settings)
        _refuse_new_errors(analysis, changed)
        documents = _documents(changed)
        others = {one.name for one in Occurrences(changed).all}
        for name in names:
            _refuse_left(name, documents, is_other=name in others)
        if _alike(_documents(analysis), names) != _alike(documents, names):
            raise RefusedError(f"the robot of {path} would differ in more than the name")


def _refuse_new_errors(before: Analysis, after: Analysis) -> None:
    errors = [
        [one for one in analysis.compilation.diagnostics if one.severity is Severity.ERROR]
        for analysis in (before, after)
    ]
    if len(errors[1]) > len(errors[0]):
        known = {one.code for one in errors[0]}
        fault = next((one for one in errors[1] if one.code not in known), errors[1][0])
        raise RefusedError(str(fault))


def _documents(analysis: Analysis) -> list[str]:
    """Return the URDF and SRDF of a robot; none for a spec with errors."""
    robot = analysis.compilation.robot
    return [] if robot is None else [render_urdf(robot), render_srdf(robot)]


def _refuse_left(name: str, documents: Iterable[str], *, is_other: bool) -> None:
    """Raise RefusedError for a name that is left in text that nobody renames; another part may have the name too."""
    word = re.compile(rf"(?<![\w/.-]){re.escape(name)}(?![\w/.-])")
    for line in (line for document in documents for line in document.split("\n")):
        if word.search(line.replace(f'"{name}"', '""') if is_other else line):
            raise RefusedError(f"'{name}' is in text that others read, which is not renamed: {line.strip()}")


def _alike(documents: Iterable[str], names: Mapping[str, str]) -> list[str]:
    """Return documents in which old and new names are the same."""
    alike = {f'"{name}"': f'"{old}"' for old, new in names.items() for name in (old, new)}
    pattern = re.compile("|".join(map(re.escape, alike)))
    return [pattern.sub(lambda found: alike[found[0]], text) for text in documents]
