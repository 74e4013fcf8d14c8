"""Names that one part of a robot uses for another, and what is told when nothing bears them."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from dataclasses import replace
from itertools import islice
from typing import TYPE_CHECKING, NamedTuple

from linkforge_compile.diagnostics import Code, Diagnostic, Note, UnresolvedNames
from linkforge_compile.source import Key, SourceRef, Span

if TYPE_CHECKING:
    from linkforge_compile.core.models.srdf import GroupState


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

    def key(self, name: str) -> Key:
        """Return the key by which this thing's file writes a name in it: without the prefix that both have got."""
        return Key(name.removeprefix(self.prefix))

    @property
    def place(self) -> Span | None:
        """Where the name stands; one place for all uses of its file. None if it was never written."""
        return self.source.at(*self.path) if self.source else None

    def note(self, message: str) -> Note:
        return Note(message, self.place)

    def notes(self, message: str) -> list[Note]:
        """Return the note with those on how its file came in: a file used twice writes two things in one place."""
        uses = self.source.trail if self.source else ()
        return [self.note(message), *(Note("used here", use) for use in uses)]


def own_positions(state: GroupState) -> dict[str, Key]:
    """Return the joints that a state sets by itself, with their keys in it; not those whose position it takes over.

    A position taken over from another group's state is judged there, once. A state built in Python sets all its own.
    """
    holder = Use(state.name, "", state.source)
    keys = {joint: holder.key(joint) for joint in state.joint_values}
    if state.source is None:
        return keys
    return {joint: key for joint, key in keys.items() if state.source.node.child(key) is not None}


MOST_OFFERED = 100
"""So many wrong names are one bad rename: nobody reads more offers, and each costs a look at every name there is."""


def unknown(
    uses: Iterable[Use],
    code: Code,
    known: Iterable[str],
    unresolved: UnresolvedNames,
    *,
    offered: Iterable[str] | None = None,
    **facts: object,
) -> Iterator[Diagnostic]:
    """Tell every use of a name that is neither known nor known to be missing, in the words of the file that uses it.

    `offered` are the names that may be meant, all that are known unless said.
    """
    told = 0
    names = dict.fromkeys(known)
    candidates = names if offered is None else dict.fromkeys(offered)
    for use in uses:
        if use.name not in names and use.name not in unresolved:
            prefix = use.prefix
            why = unresolved.deleted.notes(use.name)
            is_offered = not why and told < MOST_OFFERED
            near = [name.removeprefix(prefix) for name in candidates if name.startswith(prefix)] if is_offered else []
            yield use.told(code, name=use.name.removeprefix(prefix), near=near, notes=why, **facts)
            told += 1


SHOWN = 8
"""How many names a message spells out, and how many second places it shows."""


def listed(names: Collection[str], count: int | None = None) -> str:
    """Return "'a', 'b' and 'c'", or the first few and how many more; of a `count` the first few are enough."""
    quoted = [f"'{name}'" for name in islice(names, SHOWN)]
    if (more := (count or len(names)) - SHOWN) > 0:
        quoted[SHOWN - 1 :] = [f"{more + 1} more"]
    return " and ".join(filter(None, (", ".join(quoted[:-1]), quoted[-1])))
