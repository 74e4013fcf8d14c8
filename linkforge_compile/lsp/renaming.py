"""What a name at a position names, and every place that is to change with it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple

from linkforge_compile.analysis import Analysis
from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.lsp.occurrence import Occurrence
from linkforge_compile.lsp.occurrences import Occurrences
from linkforge_compile.lsp.workspace import Document
from linkforge_compile.roots import identity
from linkforge_compile.source import Position, Span
from linkforge_compile.syntax import read


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

    @property
    def is_of_expressions(self) -> bool:
        """Whether the name is one that expressions use, not that of a part."""
        return any(one.scope for one in self.occurrences)


def renamed_at(document: Document, at: Position) -> tuple[Span, Renaming] | None:
    """Return the text of the name at a position and what it names; None if no name of a part is there.

    Raises:
        RefusedError: the name cannot be changed where it is written.

    """
    return find_renaming(document, at, [Occurrences(analysis) for analysis in document.analyses])


def find_renaming(document: Document, at: Position, indexes: Sequence[Occurrences]) -> tuple[Span, Renaming] | None:
    """Return the same as `renamed_at`, with the places in some specs that may read the document."""
    _refuse_malformed(document)
    real = identity(document.path)
    here = next((found[0] for index in indexes if (found := index.at(real, at))), None)
    if here is None:
        return None
    found = tuple(_connected(indexes, here))
    declared = [one for one in found if one.is_declaration]
    if not declared:
        raise RefusedError(f"no spec declares the {here.kind} '{here.name}'")
    if here.kind == "module":
        _refuse_prefix(here, [index.analysis for index in indexes])
    suffixes = {one.named: one.suffix for one in declared if one.suffix}
    own = [one for one in declared if one.named == here.named]
    renaming = Renaming(here.kind, min(map(_fixed_end, own), key=len), found, suffixes)
    return unquoted(here.span), renaming


def _refuse_malformed(document: Document) -> None:
    """Raise RefusedError for a text that cannot be read, so that what is known of it is from an earlier one."""
    faults = Diagnostics()
    if read(document.file, faults) is None:
        fault = next(iter(faults), None)
        raise RefusedError(f"the text cannot be read; mend it first: {fault}")


def _refuse_prefix(module: Occurrence, analyses: Iterable[Analysis]) -> None:
    """Raise RefusedError for a module whose name is the prefix of the names in it."""
    uses = (use for analysis in analyses if analysis.instance for use in analysis.instance.with_modules)
    for use in uses:
        if use.entry and use.entry.key and use.entry.key.span == module.span and use.entry.node.child("prefix") is None:
            raise RefusedError(
                f"the names in module '{module.written}' begin with its name; to keep them, "
                f"write 'prefix: {module.written}_' in its entry first"
            )


def _connected(indexes: Sequence[Occurrences], first: Occurrence) -> list[Occurrence]:
    """Return the occurrences of all parts that are renamed with one, since a place writes the names of both."""
    at_place: dict[str, list[tuple[int, Occurrence]]] = {}
    of_part: dict[tuple[int, tuple[str, str, str]], list[Occurrence]] = {}
    for number, index in enumerate(indexes):
        for one in index.all:
            # A part is one of a robot; a name of expressions is that of a file, whichever robot it is read for.
            owner = -1 if one.scope else number
            at_place.setdefault(str(one.span), []).append((owner, one))
            of_part.setdefault((owner, one.named), []).append(one)
    found: dict[Occurrence, None] = {}
    reached, waiting = {str(first.span)}, [str(first.span)]
    while waiting:
        for owner, one in at_place[waiting.pop()]:
            for other in of_part.pop((owner, one.named), ()):
                found[other] = None
                if str(other.span) not in reached:
                    reached.add(str(other.span))
                    waiting.append(str(other.span))
    return list(found)


def places_by_file(renaming: Renaming) -> dict[str, list[Span]]:
    """Return where the name is written, each place once, by the real path of the file."""
    # Those with an expression first, since the reason of a refusal is there.
    spans = [
        _place_of(one, renaming) for one in sorted(renaming.occurrences, key=lambda one: one.is_computed, reverse=True)
    ]
    found: dict[str, dict[tuple[Position, Position], Span]] = {}
    for span in spans:
        if span.file.path:
            found.setdefault(identity(span.file.path), {}).setdefault((span.start, span.end), span)
    return {path: [*places.values()] for path, places in found.items()}


def _place_of(one: Occurrence, renaming: Renaming) -> Span:
    """Return the place of the text that changes in an occurrence; RefusedError if no text there writes it."""
    after = "" if one.suffix else renaming.suffix(one)
    end = _fixed_end(one)
    if not end.endswith(renaming.name + after) or not one.name.endswith(renaming.name + renaming.suffix(one)):
        raise RefusedError(computed_name(one))
    span, length = unquoted(one.span), len(renaming.name)
    return span.within(span.end_column - span.column - len(after) - length, length)


def _fixed_end(one: Occurrence) -> str:
    """Return what the text of a name writes after the last expression in it; RefusedError for nothing."""
    text = unquoted(one.span).text or ""
    end = text.rpartition(")")[2] if one.is_computed else text
    is_name = one.name.endswith(end + one.suffix) if one.is_computed else text == one.written
    if one.span.file.is_xml:
        raise RefusedError(f"the {one.kind} '{one.name}' is written in {one.span.file.shown}, which is not a spec")
    if not end or not is_name:
        raise RefusedError(computed_name(one))
    return end


def computed_name(one: Occurrence) -> str:
    """Return the reason why a name cannot be changed at a place that computes it."""
    return f"the name '{one.name}' is made of '{unquoted(one.span).text}' at {one.span}"


def unquoted(span: Span) -> Span:
    """Return the place of a name without its quotes; a place over several lines as it is."""
    text = span.text or ""
    is_quoted = len(text) > 1 and text[0] == text[-1] and text[0] in "'\""
    return span.within(1, len(text) - 2) if is_quoted else span
