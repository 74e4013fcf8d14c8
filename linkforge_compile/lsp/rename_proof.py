"""Prove that a rename changes a name and nothing else: no text that may be the name is left, and the robot is alike."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from lxml import etree

from linkforge_compile.analysis import Analysis, Settings, analyse_path
from linkforge_compile.diagnostics import Diagnostic, Severity
from linkforge_compile.expand import Instance
from linkforge_compile.formats.render import render, render_srdf, render_urdf
from linkforge_compile.lsp.free_texts import free_texts, has_word
from linkforge_compile.lsp.module_entries import unused_entries
from linkforge_compile.lsp.occurrence import Occurrence
from linkforge_compile.lsp.occurrences import Occurrences
from linkforge_compile.lsp.renaming import RefusedError, Renaming
from linkforge_compile.roots import identity
from linkforge_compile.source import Span


class Compiled(NamedTuple):
    """A spec, the settings that it is compiled with, which may have a variant, and all names in it."""

    path: Path
    settings: Settings
    occurrences: Occurrences

    @property
    def analysis(self) -> Analysis:
        return self.occurrences.analysis

    @property
    def label(self) -> str:
        """The spec and its variant, as messages name them."""
        return f"{self.path}, variant '{self.settings.variant}'" if self.settings.variant else str(self.path)

    def after(self, texts: Mapping[str, str]) -> Compiled:
        """Return it with other texts of some files."""
        settings = self.settings._replace(buffers={**self.settings.buffers, **texts})
        return self._replace(occurrences=Occurrences(analyse_path(self.path, settings)))


def prove(
    spec: Compiled, renaming: Renaming, new: str, texts: Mapping[str, str], defaults: Mapping[str, Compiled]
) -> None:
    """Compile a spec with the edited texts; RefusedError unless it differs in the name only.

    `defaults` are the specs of the workspace by their real paths, of which this one may use some under a condition.
    """
    own = frozenset(spec.occurrences.all)
    names = {one.named: renaming.renamed(one, new) for one in renaming.occurrences if one in own}
    taken = {one.named for one in own if one.is_declaration}
    for (kind, _, scope), name in names.items():
        if (kind, name, scope) in taken:
            raise RefusedError(f"there is a {kind} '{name}' already")
    if fault := _first_error(spec.analysis):
        raise RefusedError(f"mend the errors first: {fault}")
    if renaming.kind != "module" and not renaming.is_of_expressions:
        _refuse_free_texts(spec, renaming, texts, defaults)
    after = spec.after(texts)
    if fault := _first_error(after.analysis):
        raise RefusedError(f"renaming would break the robot: {fault}")
    if place := _rebound(spec.occurrences, after.occurrences):
        raise RefusedError(f"'{new}' would be another name at {place}: {_line_of(place)}")
    _refuse_differences(spec, after, {old: name for old, name in names.items() if not old[2]})


def _first_error(analysis: Analysis) -> Diagnostic | None:
    return next((one for one in analysis.compilation.diagnostics if one.severity is Severity.ERROR), None)


def _refuse_free_texts(
    spec: Compiled, renaming: Renaming, edited: Collection[str], defaults: Mapping[str, Compiled]
) -> None:
    """Raise RefusedError for a text that may be the name and is not changed."""
    own = spec.occurrences.all
    places, renamed = {one.span for one in own}, {one.span for one in _of(renaming, spec)}
    kinds, kinds_at = {one.kind for one in renaming.occurrences}, _kinds_at(own)
    finals = {_in_documents(one.kind, one.name) for one in _of(renaming, spec)}
    written = {one.written for one in renaming.occurrences if not one.is_computed}
    parts = {one.named for one in own if one.is_declaration and not one.scope}
    declared = {_in_documents(kind, name) for kind, name, _ in parts}
    for instance, prefix in _uses(spec.analysis.instance, ""):
        unused = {*_in_unused(instance, prefix, renaming, defaults)}
        for one in own:
            if one.name in unused and one.named not in parts:
                _refuse_text(one.name, one.span, renaming)
        if instance.spec is None or instance.spec.file.is_xml:
            continue
        names = unused | {name.removeprefix(prefix) for name in finals if name.startswith(prefix)}
        if instance.spec.file.path and identity(instance.spec.file.path) in edited:
            names |= {name for name in written if prefix + name not in declared}
        for text in free_texts(instance.spec.tree, places):
            if text.may_be(names) and kinds_at.get(text.span, kinds) & kinds and text.span not in renamed:
                _refuse_text(text.text or text.span.text or "", text.span, renaming)


def _kinds_at(names: Iterable[Occurrence]) -> dict[Span, set[str]]:
    """Return which kinds of parts are named at a place."""
    kinds: dict[Span, set[str]] = {}
    for one in names:
        if not one.scope:
            kinds.setdefault(one.span, set()).add(one.kind)
    return kinds


def _refuse_text(text: str, place: Span, renaming: Renaming) -> None:
    raise RefusedError(
        f"'{text}' at {place} may be the {renaming.kind} '{renaming.name}', and is not renamed: {_line_of(place)}"
    )


def _line_of(place: Span) -> str:
    return place.file.line(place.line).strip()


def _of(renaming: Renaming, spec: Compiled) -> Iterator[Occurrence]:
    """Yield what is renamed in a spec."""
    own = frozenset(spec.occurrences.all)
    return (one for one in renaming.occurrences if one in own)


def _uses(instance: Instance | None, outer: str) -> Iterator[tuple[Instance, str]]:
    """Yield the uses of files in a robot, with the prefixes of the names in them."""
    if instance is not None:
        yield instance, outer + instance.prefix
        for module in instance.modules:
            yield from _uses(module, outer + instance.prefix)


def _in_unused(instance: Instance, prefix: str, renaming: Renaming, defaults: Mapping[str, Compiled]) -> Iterator[str]:
    """Yield the names of what is renamed in modules that a use of a file would have if their `when` held."""
    for unused in unused_entries(instance, prefix):
        module = defaults.get(identity(unused.path))
        for one in _of(renaming, module) if module else ():
            yield unused.prefix + _in_documents(one.kind, one.name)


def _rebound(before: Occurrences, after: Occurrences) -> Span | None:
    """Return where a name of expressions is that of something else than before; None if each is that of the same."""
    uses, same = ([one for one in index.all if one.scope] for index in (before, after))
    for one, first, new_first in zip(uses, _firsts(uses), _firsts(same), strict=False):
        if first != new_first:
            return one.span
    return None if len(uses) == len(same) else uses[0].span if uses else same[0].span


def _firsts(names: Sequence[Occurrence]) -> list[int]:
    """Return for each name which of them is the first that names the same."""
    known: dict[tuple[str, str, str], int] = {}
    return [known.setdefault(one.named, number) for number, one in enumerate(names)]


def _refuse_differences(before: Compiled, after: Compiled, names: Mapping[tuple[str, str, str], str]) -> None:
    """Raise RefusedError if a robot differs in more than some names, by what they name."""
    documents = _documents(after.analysis)
    others = {_in_documents(one.kind, one.name) for one in after.occurrences.all if not one.scope}
    finals = {_in_documents(kind, old): _in_documents(kind, name) for (kind, old, _), name in names.items()}
    for name in finals:
        _refuse_left(name, documents, is_other=name in others)
    if _alike(_documents(before.analysis), finals) != _alike(documents, finals):
        raise RefusedError(f"the robot of {before.label} would differ in more than the name")


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
    for document in documents[:2]:
        for element in etree.fromstring(document.encode()).iter(etree.Element):
            is_root = element.getparent() is None  # it has the name of the robot
            values = [str(value) for key, value in element.attrib.items() if key != "type" and not is_root]
            values += [element.text or ""] if element.tag != "topic" else []
            if any(has_word(value, [name]) and not (is_other and value == name) for value in values):
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
