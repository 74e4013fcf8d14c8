"""One thing to tell the user, and the code that names its kind."""

from __future__ import annotations

import sys
from collections.abc import Iterable
from dataclasses import dataclass
from enum import StrEnum
from typing import TypeAlias

from linkforge_compile.diagnostics.suggest import did_you_mean
from linkforge_compile.source import SourceRef, Span
from linkforge_compile.source.characters import on_one_line
from linkforge_compile.source.provenance import Location, Provenance, provenance_of

Where: TypeAlias = Span | SourceRef | None
"""A place: a span of text, an object's reference, or None for a value that was never written (built in Python)."""

_LONGEST = 2_000
"""Characters of a message and of a note: a name may have megabytes."""


class Severity(StrEnum):
    """An error makes the output invalid or other than what was written; a warning and a note let it through."""

    ERROR = "error"
    WARNING = "warning"
    NOTE = "note"


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
    severity_override: Severity | None = None
    """What the user counts it for, None for what its code is."""
    omitted: int = 0
    """How many more like it there are at its place, which a note counts and nobody tells."""
    full_text_hash: int = 0
    """What the message was before its middle was left out, as a hash: two of one beginning and end are two faults."""

    @property
    def severity(self) -> Severity:
        return self.severity_override or self.code.severity

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
    location: Location = Location.USE
    is_unknown_name: bool = False
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
        chain = provenance_of(where, *path, location=self.location) if where else None
        span = chain.span if chain else None
        sentence = self.in_xml if self.in_xml and span and span.file.is_xml else self.message
        whole = sentence.format(**facts) + did_you_mean(str(facts.get("name", "")), near)
        full_text_hash = hash(whole) if len(whole) > _LONGEST else 0
        return Diagnostic(self, _quotable(whole), span, (*notes, *notes_of(chain)), full_text_hash=full_text_hash)


def notes_of(chain: Iterable[Provenance] | None) -> tuple[Note, ...]:
    """Return a note for each link that diagnostics show."""
    return tuple(Note(link.note, link.span) for link in chain or () if link.note)


def _quotable(text: str) -> str:
    """Return what hostile files hold as a message may quote it: its middle left out where nobody reads so much, on one
    line.
    """
    if len(text) > _LONGEST:
        text = f"{text[: _LONGEST // 2]}…{text[-_LONGEST // 2 :]}"
    return on_one_line(text)
