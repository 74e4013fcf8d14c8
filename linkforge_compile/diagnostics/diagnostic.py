"""One thing to tell the user, and the code that names its kind."""

from __future__ import annotations

import sys
from collections.abc import Iterable
from dataclasses import dataclass
from enum import Enum, StrEnum
from typing import TypeAlias

from linkforge_compile.diagnostics.suggest import did_you_mean
from linkforge_compile.source import Change, SourceRef, Span
from linkforge_compile.source.characters import on_one_line

Where: TypeAlias = Span | SourceRef | None
"""A place: a span of text, an object's reference, or None for a value that was never written (built in Python)."""

_LONGEST = 2_000
"""Characters of a message and of a note: a name may have megabytes."""


class Severity(StrEnum):
    """An error makes the output invalid or other than what was written; a warning and a note let it through."""

    ERROR = "error"
    WARNING = "warning"
    NOTE = "note"


class Blame(Enum):
    """Who is to mend what is wrong with a value that an expression hands on from where it was written."""

    USER = "user"
    """The place that uses it."""
    KIND = "kind"
    """A value of another kind than its place takes: that place too, unless it is read from a file of data."""
    WRITER = "writer"
    """Whoever wrote the value."""


@dataclass(frozen=True)
class Note:
    """A second place that explains the first, such as where the other of two equal names stands."""

    message: str
    span: Span | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "message", _quotable(self.message))


@dataclass(frozen=True)
class Diagnostic:
    """One fault, told once: `message` is lower case, without full stop, the user's own words in quotes."""

    code: Code
    message: str
    span: Span | None
    notes: tuple[Note, ...] = ()
    taken_for: Severity | None = None
    """What the user counts it for, None for what its code is."""
    untold: int = 0
    """How many more like it there are at its place, which a note counts and nobody tells."""
    left_out: int = 0
    """What the message was before its middle was left out, as a hash: two of one beginning and end are two faults."""

    @property
    def severity(self) -> Severity:
        return self.taken_for or self.code.severity

    @property
    def order(self) -> tuple[int, str, int, int]:
        """A sort key: reading order; what has no place comes first, and what ends the report last."""
        if self.code.ends_report:
            return sys.maxsize, "", 0, 0
        return self.span.order if self.span else (-1, "", 0, 0)

    def __str__(self) -> str:
        place = f"{self.span}: " if self.span else ""
        return f"{place}{self.severity}: {self.message} [{self.code.id}]"


@dataclass(frozen=True)
class Code:
    """A kind of fault. `message` is its sentence, with the facts it needs as `{name}` fields.

    `in_xml` is the sentence for a URDF, SRDF or xacro, whose author writes elements and not keys of the language;
    empty where one suits all.

    Ids are never renumbered nor reused: people write them into ignore comments and CI settings.
    """

    id: str
    severity: Severity
    message: str
    blame: Blame = Blame.USER
    is_of_a_name: bool = False
    """Whether it tells of a name that is declared nowhere: all who use the name have one cause."""
    in_xml: str = ""
    ends_report: bool = False
    """Whether it says that there is more than is told: it comes behind all others, wherever its place is, and is never
    left out itself."""

    @property
    def title(self) -> str:
        """The sentence as it stands before there are facts: "no link named '…'"."""
        from string import Formatter

        return "".join(text + "…" * (field is not None) for text, field, *_ in Formatter().parse(self.message))

    @property
    def help(self) -> str:
        """Where the way out is told at length."""
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

        `near` lists the names that would have been right: the one like the fact `name`, if any, is offered.
        """
        span = where.at(*path) if isinstance(where, SourceRef) else where
        trail = where.trail_to(span) if isinstance(where, SourceRef) and span else ()
        changed = notes_of_changes(where.changes(*path), span) if isinstance(where, SourceRef) else ()
        brought = brought_in_at(where.brought_in(*path)) if isinstance(where, SourceRef) else ()
        span, moved = self._blamed(span) if span else (None, ())
        sentence = self.in_xml if self.in_xml and span and span.file.is_xml else self.message
        whole = sentence.format(**facts) + did_you_mean(str(facts.get("name", "")), near)
        left_out = hash(whole) if len(whole) > _LONGEST else 0
        includes = [Note("included here", include) for include in (span.file.includes if span else ())]
        uses = [Note("used here", use) for use in trail]
        all_notes = (*notes, *brought, *moved, *changed, *includes, *uses)
        return Diagnostic(self, _quotable(whole), span, all_notes, left_out=left_out)

    def _blamed(self, used: Span) -> tuple[Span, tuple[Note, ...]]:
        """Return the place to blame for a value that stands at one, and the other of its two places as a note."""
        origin = used.origin
        if origin is None:
            return used, ()
        if self.blame is Blame.WRITER or (self.blame is Blame.KIND and origin.is_data):
            return origin.span, (Note("the value is used here", used),)
        meant = used.meant if self.blame is Blame.KIND else None
        way_out = f"; write '{meant}'" if meant else ""
        return used, (Note(f"the value is written here{way_out}", origin.span),)


def brought_in_at(places: Iterable[Span]) -> tuple[Note, ...]:
    """Return where aliases and `<<` bring in what is told."""
    return tuple(Note("brought in here", place) for place in places)


def notes_of_changes(changes: Iterable[Change], told: Span | None) -> tuple[Note, ...]:
    """Return what overrides changed in an object of which something is told, () where that is what they say."""
    known = tuple(changes)
    if told is not None and any(told.lies_in(change.span) for change in known):
        return ()
    return tuple(Note(f"'{change.key}' is changed by this override", change.span) for change in known)


def _quotable(text: str) -> str:
    """Return what hostile files hold as a message may quote it: its middle left out where nobody reads so much, on one
    line.
    """
    if len(text) > _LONGEST:
        text = f"{text[: _LONGEST // 2]}…{text[-_LONGEST // 2 :]}"
    return on_one_line(text)
