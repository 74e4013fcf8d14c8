"""What is missing because it was faulty and has been reported: who looks for it stays silent."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from linkforge_compile.diagnostics.diagnostic import Note


@dataclass(frozen=True, slots=True)
class Gaps:
    """Names that the author wrote and the robot lacks.

    `prefixes` stand for whole modules that could not be read: every name that begins with one may be theirs,
    and the empty prefix covers all names. True when anything is missing, so a check that judges the whole
    tree can tell that it does not see the whole tree. `removed` are no gaps: names that are not there because the
    author said so, each with the note that shows where, for whoever misses them.
    """

    names: frozenset[str] = frozenset()
    prefixes: tuple[str, ...] = ()
    removed: Mapping[str, Note] = field(default_factory=dict)

    def __contains__(self, name: object) -> bool:
        return name in self.names or (isinstance(name, str) and name.startswith(self.prefixes))

    def __bool__(self) -> bool:
        return bool(self.names or self.prefixes)

    def with_prefix(self, prefix: str) -> Gaps:
        """Return the same gaps as seen from the file that uses this one under `prefix`."""
        names = frozenset(prefix + name for name in self.names)
        removed = {prefix + name: note for name, note in self.removed.items()}
        return Gaps(names, tuple(prefix + start for start in self.prefixes), removed)

    def __or__(self, other: Gaps) -> Gaps:
        removed = {**other.removed, **self.removed}
        return Gaps(self.names | other.names, self.prefixes + other.prefixes, removed)
