"""Names that one part of a robot uses for another, and what is told when nothing bears them."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from dataclasses import replace
from typing import NamedTuple

from linkforge_compile.diagnostics import Code, Diagnostic, Gaps, Note
from linkforge_compile.source import SourceRef


class Use(NamedTuple):
    """A name, who uses it ("joint 'elbow'", or nobody), and where: a path below the place of its user."""

    name: str
    user: str
    source: SourceRef | None
    path: tuple[str | int, ...] = ()

    def told(self, code: Code, *, near: Iterable[str] = (), notes: Iterable[Note] = (), **facts: object) -> Diagnostic:
        """Make the diagnostic about this use; where it has no place, its message begins with the user instead.

        A robot built in Python was never written, and two users of one wrong name are two faults.
        """
        diagnostic = code.at(self.source, *self.path, near=near, notes=notes, **facts)
        if diagnostic.span or not self.user:
            return diagnostic
        return replace(diagnostic, message=f"{self.user}: {diagnostic.message}")

    @property
    def prefix(self) -> str:
        """What the modules around it have put before the name as its file writes it.

        Two uses of a module with one wrong name are one fault of its file, told in one way.
        """
        if not (self.source and self.source.trail):
            return ""
        span = self.source.at(*self.path)
        end = span.end_column - 1 if span.line == span.end_line else None
        written = span.file.line(span.line)[span.column - 1 : end].strip("'\"")
        return self.name.removesuffix(written) if written and self.name.endswith(written) else ""

    def note(self, message: str) -> Note:
        return Note(message, self.source.at(*self.path) if self.source else None)


def unknown(uses: Iterable[Use], code: Code, known: Iterable[str], gaps: Gaps) -> Iterator[Diagnostic]:
    """Tell every use of a name that is neither known nor known to be missing, in the words of the file that uses it."""
    names = dict.fromkeys(known)
    for use in uses:
        if use.name not in names and use.name not in gaps:
            prefix = use.prefix
            near = (name.removeprefix(prefix) for name in names if name.startswith(prefix))
            yield use.told(code, name=use.name.removeprefix(prefix), near=near)


SHOWN = 8
"""How many names a message spells out, and how many second places it shows."""


def listed(names: Collection[str]) -> str:
    """Return "'a', 'b' and 'c'", or the first few and how many more."""
    quoted = [f"'{name}'" for name in names]
    if len(quoted) > SHOWN:
        quoted[SHOWN - 1 :] = [f"{len(quoted) - SHOWN + 1} more"]
    return " and ".join(filter(None, (", ".join(quoted[:-1]), quoted[-1])))
