"""Names that a robot lacks because of errors that are already reported; checks skip them to avoid follow-on errors."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

from linkforge_compile.diagnostics.diagnostic import Note


@dataclass(frozen=True)
class DeletedNames:
    """Names that the author deleted, each with the note that shows where; `starts` are prefixes of whole modules."""

    names: Mapping[str, Note] = field(default_factory=dict)
    starts: Mapping[str, Note] = field(default_factory=dict)

    def notes(self, name: str) -> list[Note]:
        """Return the note that shows where a name was deleted, [] if it was not."""
        if name in self.names:
            return [self.names[name]]
        return [note for start, note in self.starts.items() if start and name.startswith(start)][:1]

    def with_prefix(self, prefix: str) -> DeletedNames:
        names = {prefix + name: note for name, note in self.names.items()}
        return DeletedNames(names, {prefix + start: note for start, note in self.starts.items()})

    def __or__(self, other: DeletedNames) -> DeletedNames:
        return DeletedNames({**other.names, **self.names}, {**other.starts, **self.starts})


def _everywhere(_: Path) -> bool:
    return True


@dataclass(frozen=True)
class UnresolvedNames:
    """Names that the author wrote and that the robot lacks, because their definitions have errors.

    `prefixes` stand for modules that could not be read: every name that begins with one may be defined there, and the
    empty prefix covers all names. Truth means that something is missing, so that a check of the whole tree can skip it.
    `deleted` names are not unresolved; they explain an unknown name. Nor are `mounts`, the joint that a robot without a
    parent lacks. `may_look` tells whether a check may read a file, as a spec can name any file of this machine.
    """

    names: frozenset[str] = frozenset()
    prefixes: tuple[str, ...] = ()
    deleted: DeletedNames = field(default_factory=DeletedNames)
    mounts: frozenset[str] = frozenset()
    may_look: Callable[[Path], bool] = _everywhere

    def with_access(self, may_look: Callable[[Path], bool]) -> UnresolvedNames:
        """Return the same names with another rule of which files a check may read."""
        return replace(self, may_look=may_look)

    def __contains__(self, name: object) -> bool:
        return name in self.names or name in self.mounts or (isinstance(name, str) and name.startswith(self.prefixes))

    def __bool__(self) -> bool:
        return bool(self.names or self.prefixes)

    def with_prefix(self, prefix: str) -> UnresolvedNames:
        """Return the same names as seen from the file that imports this one under `prefix`."""
        names = frozenset(prefix + name for name in self.names)
        starts = tuple(prefix + start for start in self.prefixes)
        mounts = frozenset(prefix + name for name in self.mounts)
        return UnresolvedNames(names, starts, self.deleted.with_prefix(prefix), mounts)

    def __or__(self, other: UnresolvedNames) -> UnresolvedNames:
        prefixes, mounts = self.prefixes + other.prefixes, self.mounts | other.mounts
        return UnresolvedNames(self.names | other.names, prefixes, self.deleted | other.deleted, mounts)
