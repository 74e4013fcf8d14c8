"""A diagnostic, and the code that names its kind."""

from __future__ import annotations

import sys
from collections.abc import Collection, Hashable, Iterable, Mapping
from dataclasses import dataclass, replace
from enum import StrEnum
from typing import TypeAlias

from linkforge_compile.diagnostics.fix import Fix, Replacement
from linkforge_compile.diagnostics.suggest import is_other_case, suggested
from linkforge_compile.source import SourceRef, Span
from linkforge_compile.source.characters import on_one_line
from linkforge_compile.source.provenance import Location, Provenance, provenance_of

Where: TypeAlias = Span | SourceRef | None
"""A place: a span of text, an object's reference, or None for a value that no file contains."""

_LONGEST = 2_000
"""Characters of a message and of a note; a hostile name may have megabytes."""


class Severity(StrEnum):
    """Errors prevent output; warnings and notes do not."""

    ERROR = "error"
    WARNING = "warning"
    NOTE = "note"


@dataclass(frozen=True)
class Note:
    """A second place that explains the first, such as that of the other of two equal names."""

    message: str
    span: Span | None = None
    is_brief: bool = False
    """Whether the text form shows the place without its source line."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "message", _quotable(self.message))


@dataclass(frozen=True)
class Diagnostic:
    """One fault; `message` is lower case, without full stop, with the user's own words in quotes."""

    code: Code
    message: str
    span: Span | None
    notes: tuple[Note, ...] = ()
    severity_override: Severity | None = None
    """The severity that the user chose, None for that of the code."""
    omitted: int = 0
    """How many more like it are omitted; a note counts them."""
    full_text_hash: int = 0
    """A hash of the message before it was shortened, 0 if it was not; it keeps two long messages distinct."""
    subject: str = ""
    """The part at fault, empty if diagnostics of this code are not grouped."""
    grouped_by: tuple[object, ...] = ()
    """The facts that agree in a group."""
    members: tuple[Diagnostic, ...] = ()
    """All diagnostics of the group that this one reports, empty for a single diagnostic."""
    fixes: tuple[Fix, ...] = ()
    """The ways to correct it by edits, the most likely first; of a group, those of its first member."""
    is_only_counted: bool = False
    """Whether text counts it and does not show it: a loss of a format that is not written."""

    @property
    def severity(self) -> Severity:
        return self.severity_override or self.code.severity

    @property
    def order(self) -> tuple[int, str, int, int]:
        """A sort key for reading order; diagnostics without a place come first, those that end the report last."""
        if self.code.ends_report:
            return sys.maxsize, "", 0, 0
        return self.span.order if self.span else (-1, "", 0, 0)

    @property
    def group(self) -> Hashable:
        """A key that is equal for diagnostics of a file that are reported as one, None if this one is not grouped."""
        if not self.subject:
            return None
        remarks = tuple(note.message for note in self.notes if note.span is None)
        return self.code.id, self.severity, self.span.file.name if self.span else "", self.grouped_by, remarks

    def replacing(self, old: str, new: str, *, is_safe: bool = False, is_whole: bool = False) -> Diagnostic:
        """Return it with the fix of a Replacement in its span; the same diagnostic if that is not possible."""
        return self.with_fix(Replacement(old, new, is_safe, is_whole).within(self.span))

    def with_fix(self, *fixes: Fix | None) -> Diagnostic:
        """Return it with more fixes, without those that are None; the same diagnostic for none."""
        more = tuple(fix for fix in fixes if fix)
        return replace(self, fixes=(*self.fixes, *more)) if more else self

    def __str__(self) -> str:
        place = f"{self.span}: " if self.span else ""
        return f"{place}{self.severity}: {self.message} [{self.code.id}]"


@dataclass(frozen=True)
class Code:
    """A kind of fault; `message` is its sentence, with facts as `{name}` fields.

    `in_xml` is the sentence for a URDF, SRDF or xacro, empty if `message` suits them too. Ids are never renumbered or
    reused, because people write them into comments and CI settings.
    """

    id: str
    severity: Severity
    message: str
    location: Location = Location.USE
    is_unknown_name: bool = False
    """Whether it reports an undeclared name, so that all uses of the name have one cause."""
    in_xml: str = ""
    is_loss: bool = False
    """Whether it reports what a format cannot hold of the robot, or holds in another way; no fault of the spec."""
    ends_report: bool = False
    """Whether it says that the report is incomplete: it comes last and is always shown."""
    subject: str = ""
    """The fact that names the part at fault, if many parts have this fault for one cause: they are grouped."""
    grouped_by: tuple[str, ...] = ()
    """The facts that agree in a group."""
    fix: Replacement | None = None
    """What to write in the diagnostic's span, with facts as `{name}` fields; a fix only where these are given."""

    @property
    def title(self) -> str:
        """The sentence with `…` for its facts: "no link named '…'"."""
        from string import Formatter

        return "".join(text + "…" * (field is not None) for text, field, *_ in Formatter().parse(self.message))

    @property
    def help(self) -> str:
        """The command that explains the code at length."""
        return f"run 'linkforge explain {self.id}'"

    def at(
        self,
        where: Where,
        *path: str | int,
        near: Iterable[str] = (),
        notes: Iterable[Note] = (),
        **facts: object,
    ) -> Diagnostic:
        """Make the diagnostic for one place; `path` leads from an object to the field at fault.

        `near` lists the valid names, of which the one most like the fact `name` is suggested.
        """
        chain = provenance_of(where, *path, location=self.location) if where else None
        span = chain.span if chain else None
        sentence = self.in_xml if self.in_xml and span and span.file.is_xml else self.message
        near = near if isinstance(near, Collection) else tuple(near)
        suggestion = suggested(str(facts.get("name", "")), near)
        whole = sentence.format(**facts) + (f"; did you mean '{suggestion}'?" if suggestion else "")
        full_text_hash = hash(whole) if len(whole) > _LONGEST else 0
        all_notes = (*notes, *notes_of(chain))
        subject = str(facts[self.subject]) if self.subject else ""
        grouped_by = tuple(facts[fact] for fact in self.grouped_by)
        return Diagnostic(
            self,
            _quotable(whole),
            span,
            all_notes,
            full_text_hash=full_text_hash,
            subject=subject,
            grouped_by=grouped_by,
            fixes=tuple(filter(None, (self._own_fix(span, facts), _fix_name(span, facts, suggestion, near)))),
        )

    def _own_fix(self, span: Span | None, facts: Mapping[str, object]) -> Fix | None:
        """Return the fix of this kind of fault with the facts of one diagnostic, None if there is none."""
        filled = self.fix.filled(facts) if self.fix else None
        return filled.within(span) if filled else None


def _fix_name(span: Span | None, facts: Mapping[str, object], new: str | None, near: Collection[str]) -> Fix | None:
    """Return the fix that writes the suggested name; safe if it is the only one that differs in letter case alone."""
    if new is None:
        return None
    old = str(facts["name"])
    named = Replacement(old, new, is_safe=new.casefold() == old.casefold() and is_other_case(old, near))
    return named.within(span) if named.is_word_for(span) else None


def notes_of(chain: Iterable[Provenance] | None) -> tuple[Note, ...]:
    """Return a note for each link that diagnostics show."""
    return tuple(Note(link.note, link.span) for link in chain or () if link.note)


def _quotable(text: str) -> str:
    """Return a text on one line, without its middle if it is long."""
    if len(text) > _LONGEST:
        text = f"{text[: _LONGEST // 2]}…{text[-_LONGEST // 2 :]}"
    return on_one_line(text)
