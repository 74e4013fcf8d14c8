"""What is missing because it was faulty and has been reported: who looks for it stays silent."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

from linkforge_compile.diagnostics.diagnostic import Note


@dataclass(frozen=True)
class Removed:
    """Names that are not there because the author said so, each with the note that shows where.

    `starts` are the prefixes of whole modules.
    """

    names: Mapping[str, Note] = field(default_factory=dict)
    starts: Mapping[str, Note] = field(default_factory=dict)

    def why(self, name: str) -> list[Note]:
        """Return the note that says why a name is not there, [] where nobody said so."""
        if name in self.names:
            return [self.names[name]]
        return [note for start, note in self.starts.items() if start and name.startswith(start)][:1]

    def with_prefix(self, prefix: str) -> Removed:
        names = {prefix + name: note for name, note in self.names.items()}
        return Removed(names, {prefix + start: note for start, note in self.starts.items()})

    def __or__(self, other: Removed) -> Removed:
        return Removed({**other.names, **self.names}, {**other.starts, **self.starts})


def _everywhere(_: Path) -> bool:
    return True


@dataclass(frozen=True)
class Gaps:
    """Names that the author wrote and the robot lacks.

    `prefixes` stand for whole modules that could not be read: every name that begins with one may be theirs,
    and the empty prefix covers all names. True when anything is missing, so a check that judges the whole
    tree can tell that it does not see the whole tree. `removed` are no gaps, but there for whoever misses them.
    `mounts` are none either: what a robot lacks that hangs nowhere, the joint by which it would hang.
    `may_look` says whether a check may look at a file, for a spec can name any file of this machine.
    """

    names: frozenset[str] = frozenset()
    prefixes: tuple[str, ...] = ()
    removed: Removed = field(default_factory=Removed)
    mounts: frozenset[str] = frozenset()
    may_look: Callable[[Path], bool] = _everywhere

    def looking(self, may_look: Callable[[Path], bool]) -> Gaps:
        """Return the same gaps for checks that look at other files."""
        return replace(self, may_look=may_look)

    def __contains__(self, name: object) -> bool:
        return name in self.names or name in self.mounts or (isinstance(name, str) and name.startswith(self.prefixes))

    def __bool__(self) -> bool:
        return bool(self.names or self.prefixes)

    def with_prefix(self, prefix: str) -> Gaps:
        """Return the same gaps as seen from the file that uses this one under `prefix`."""
        names = frozenset(prefix + name for name in self.names)
        starts = tuple(prefix + start for start in self.prefixes)
        mounts = frozenset(prefix + name for name in self.mounts)
        return Gaps(names, starts, self.removed.with_prefix(prefix), mounts)

    def __or__(self, other: Gaps) -> Gaps:
        prefixes, mounts = self.prefixes + other.prefixes, self.mounts | other.mounts
        return Gaps(self.names | other.names, prefixes, self.removed | other.removed, mounts)
