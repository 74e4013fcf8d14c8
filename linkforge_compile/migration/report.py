"""What a migration translated, what it did not and why."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

from linkforge_compile.diagnostics import Diagnostic, Note, Severity
from linkforge_compile.diagnostics.codes.importing import (
    ARGUMENT_PINNED,
    ELEMENT_LEFT_OUT,
    ENVIRONMENT_READ,
    MACRO_IN_PLACE,
    MACRO_KEPT,
    MIGRATION_DIFFERS,
    MIGRATION_TOO_LONG,
    MIGRATION_UNPROVED,
)
from linkforge_compile.importers.element_reader import text_left_out
from linkforge_compile.importers.plugin_data import tags_grouped
from linkforge_compile.migration.attachment import parts_of
from linkforge_compile.migration.combinations import OTHER_WORD, Arguments
from linkforge_compile.migration.evaluate import Called
from linkforge_compile.migration.migrate import Migration
from linkforge_compile.migration.proof import Comparison
from linkforge_compile.migration.without_effect import PLACES

_MOST_DIFFERENCES = 5


class Proof(NamedTuple):
    """For how many combinations of arguments specs are the same robot."""

    varied: tuple[str, ...]
    """The arguments with several values in the proof."""
    settled: tuple[str, ...]
    """The other arguments, of which only one value is compared."""
    renamed: tuple[tuple[str, str], ...]
    """The arguments whose parameters have another name, which users give."""
    combinations: int
    equal: int
    unproved: int
    late: int
    """The combinations that were not compared, because the time was over."""

    def as_json(self) -> dict[str, Any]:
        return {**self._asdict(), "renamed": dict(self.renamed)}


class Figures(NamedTuple):
    """The numbers of a translation.

    Of the macros that are called, `parts` have links or joints, so that they can be modules; the others make values.
    `modules` are files, `raw_macros` of them with raw XML, and `in_place` are written where they are called.
    """

    macros: int
    parts: int
    modules: int
    in_place: int
    kept: int
    raw_macros: int
    properties: int
    variables: int
    conditions: int
    decided: int
    raw: int
    files_before: int
    lines_before: int
    files_after: int
    lines_after: int


def proof_of(migration: Migration, comparisons: Sequence[Comparison]) -> Proof:
    """Return the numbers of a proof."""
    return Proof(
        varied=tuple(name for name, values in migration.domains.items() if len(values) > 1),
        settled=tuple(name for name, values in migration.domains.items() if len(values) <= 1),
        renamed=tuple(pair for pair in migration.names.items() if pair[0] != pair[1]),
        combinations=len(comparisons),
        equal=sum(one.is_equal for one in comparisons),
        unproved=sum(one.refused is not None for one in comparisons),
        late=sum(one.is_late for one in comparisons),
    )


def figures_of(migration: Migration) -> Figures:
    """Return the numbers of a translation."""
    expander = migration.expander
    called = {one.macro.body for one in migration.calls.called}
    modules = migration.modules
    raw = [file for file in modules.values() if migration.specs[file].raw]
    elements = [one for document in expander.sources.documents.values() for one in document.root.walk()]
    tags = Counter(one.tag for one in elements)
    texts = [document.root.file.text for document in expander.sources.documents.values()]
    kept = sum(1 for spec in migration.specs.values() for symbol in spec.used if symbol.role != "parameter")
    parts = {one.macro.body for one in migration.calls.called if is_part(one)}
    return Figures(
        macros=len(called),
        parts=len(parts),
        modules=len(modules),
        in_place=len(called) - len(modules) - len(migration.calls.kept),
        kept=len(migration.calls.kept),
        raw_macros=len(raw),
        properties=tags["xacro:property"],
        variables=kept,
        conditions=tags["xacro:if"] + tags["xacro:unless"],
        decided=expander.decided,
        raw=sum(len(spec.raw) for spec in migration.specs.values()),
        files_before=len(texts),
        lines_before=sum(text.count("\n") for text in texts),
        files_after=len(migration.files),
        lines_after=sum(text.count("\n") for text in migration.files.values()),
    )


def proof_lines(proof: Proof) -> Iterator[str]:
    """Yield the lines of a report about a proof."""
    combinations = f"{proof.equal} of {_counted(proof.combinations, 'combination')}"
    unproved = f", {proof.unproved} cannot be compared" if proof.unproved else ""
    late = f", {proof.late} were not compared in the time" if proof.late else ""
    yield f"proof       the same robot for {combinations} of its arguments{unproved}{late}"
    if proof.varied or proof.settled:
        one_value = f"; with one value: {', '.join(proof.settled)}" if proof.settled else ""
        yield f"arguments   varied: {', '.join(proof.varied) or 'none'}{one_value}"
    if proof.renamed:
        names = ", ".join(f"{name} is {new}" for name, new in proof.renamed)
        yield f"renamed     {names}: launch files give the new names"


def figure_lines(figures: Figures) -> Iterator[str]:
    """Yield the lines of a report about a translation."""
    kept = f", {figures.kept} remain in xacro" if figures.kept else ""
    macros = f"{_counted(figures.modules, 'module')}, {figures.in_place} written in place{kept}"
    yield f"macros      {figures.macros}: {macros}"
    yield f"properties  {figures.properties}: {_counted(figures.variables, 'variable')} and data, the others in place"
    yield f"conditions  {figures.conditions}: {figures.decided} decided in place, the others in the specs"
    yield f"raw XML     {_counted(figures.raw, 'place')}"
    before = f"{figures.lines_before} in {_counted(figures.files_before, 'file')}"
    yield f"lines       {before} before, {figures.lines_after} in {_counted(figures.files_after, 'file')} after"


def is_part(called: Called) -> bool:
    """Whether what a call expands to has links or joints of the robot."""
    return not called.context.is_inside and any(one.tag in ("link", "joint") for one, _ in parts_of(called.content, ()))


def _counted(number: int, noun: str) -> str:
    return f"{number} {noun}{'' if number == 1 else 's'}"


def notes_of(migration: Migration) -> Iterator[Diagnostic]:
    """Yield why macros are no modules, and which arguments have one value."""
    called = {one.macro.body: one.macro for one in migration.calls.called}
    for body, reason in migration.constraints.inline.items():
        if body in called and body not in migration.calls.kept:
            yield MACRO_IN_PLACE.at(body.span, name=called[body].name, reason=reason)
    for body, reason in migration.calls.kept.items():
        yield MACRO_KEPT.at(body.span, name=called[body].name, reason=reason)
    left_out = (one.origin for spec in migration.specs.values() for one in spec.left_out if one.origin)
    for element in dict.fromkeys(left_out):
        yield ELEMENT_LEFT_OUT.at(element.span, tag=element.tag, place=PLACES.get(element.tag, "a joint of this type"))
    elements = [one for document in migration.expander.sources.documents.values() for one in document.root.walk()]
    messages = frozenset().union(*(spec.notes for spec in migration.specs.values()))
    about = (found for one in elements for found in (text_left_out(one), tags_grouped(one, one.children)) if found)
    yield from (found for found in about if found.message in messages)
    for name in sorted(migration.constraints.pinned):
        symbol = migration.expander.arguments[name]
        value = str(symbol.constant)
        needed = migration.constraints.needed.get(name)
        notes = [needed] if needed and needed.span else []
        yield ARGUMENT_PINNED.at(
            symbol.where, name=name, value=value.lower() if isinstance(symbol.constant, bool) else value, notes=notes
        )
    for name, value in migration.expander.environment.items():
        reads = re.compile(rf"\$\(optenv\s+{re.escape(name)}\b")
        users = [one.span for one in elements if reads.search(one.raw)]
        yield ENVIRONMENT_READ.at(users[-1] if users else None, name=name, value=value)  # the inner element


def errors_of_specs(comparisons: Sequence[Comparison]) -> Iterator[Diagnostic]:
    """Yield the errors of specs, each once, with the arguments for which it is one unless it is for all."""
    found: dict[Diagnostic, list[Arguments]] = {}
    for one in comparisons:
        for error in one.errors:
            found.setdefault(error, []).append(one.arguments)
    compiled = sum(not (one.refused or one.is_late) for one in comparisons)
    for error, combinations in found.items():
        notes = [] if len(combinations) == compiled else [Note(f"this is with {_all_words(combinations)}")]
        yield replace(error, notes=(*error.notes, *notes))


def faults_of(comparisons: Sequence[Comparison], seconds: float) -> Iterator[Diagnostic]:
    """Yield what differs, and what was not compared, some of it as that would take longer than a time."""
    late = [one.arguments for one in comparisons if one.is_late]
    if late:
        what = f"the comparison of {_counted(len(late), 'combination')}, the first with {_words(late[0])},"
        yield MIGRATION_TOO_LONG.at(None, what=what, seconds=f"{seconds:g}")
    refused: dict[str, list[Arguments]] = {}
    differences: dict[str, list[Arguments]] = {}
    for one in comparisons:
        if one.refused is not None:
            refused.setdefault(one.refused, []).append(one.arguments)
        for text in (one.fault,) if one.fault else one.differences[:_MOST_DIFFERENCES]:
            differences.setdefault(text, []).append(one.arguments)
    for reason, combinations in refused.items():
        found = MIGRATION_UNPROVED.at(None, arguments=_all_words(combinations), reason=reason)
        # That a xacro refuses the word that migrate made up is no fault of the xacro.
        is_made_up = all(OTHER_WORD in one.values() for one in combinations)
        yield replace(found, severity_override=Severity.NOTE) if is_made_up else found
    for text, combinations in differences.items():
        notes = [Note("this is a change from the robot of xacro to that of the specs")] if " → " in text else []
        yield MIGRATION_DIFFERS.at(None, arguments=_all_words(combinations), text=text, notes=notes)


def _all_words(combinations: Sequence[Arguments]) -> str:
    first, *others = combinations
    return _words(first) + (f" and {_counted(len(others), 'other combination')}" if others else "")


def _words(arguments: Arguments) -> str:
    return " ".join(f"{name}:={value}" for name, value in arguments.items()) or "all defaults"
