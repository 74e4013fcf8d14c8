"""The files that a compile has read so far, and what became of each."""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import Any

from linkforge_compile.load.spec_tree import ComposedFile
from linkforge_compile.source import SourceFile
from linkforge_compile.syntax import YamlNode


@dataclass
class FilesRead:
    """Lists in the order read, paths as their user would type them, and mappings by real path.

    A file that is included twice is twice in `sources`. `meshes` are those that an inertia was computed from, each as
    often as it was requested. The files of `unread` and `unread_meshes` do not exist or cannot be read.
    """

    sources: list[SourceFile] = field(default_factory=list)
    specs: dict[str, ComposedFile | None] = field(default_factory=dict)
    data: dict[str, YamlNode | None] = field(default_factory=dict)
    xml: dict[str, SourceFile] = field(default_factory=dict)
    by_xacro: list[Path] = field(default_factory=list)
    unread: list[Path] = field(default_factory=list)
    meshes: list[Path] = field(default_factory=list)
    unread_meshes: list[Path] = field(default_factory=list)

    @property
    def names(self) -> tuple[object, ...]:
        """What was read as what: two compiles with the same names have read the same."""
        return (*self.sources, *self.specs, None, *self.data, None, *self.xml, frozenset(self.meshes))

    def copy(self) -> FilesRead:
        return FilesRead(*(getattr(self, each.name).copy() for each in fields(self)))

    def since(self, before: FilesRead) -> FilesRead:
        """Return what was added since `before` was copied."""
        added: list[Any] = []  # each field has a type of its own
        for each in fields(self):
            now, then = getattr(self, each.name), getattr(before, each.name)
            is_list = isinstance(now, list)
            added.append(now[len(then) :] if is_list else {key: now[key] for key in now if key not in then})
        return FilesRead(*added)

    def add(self, others: FilesRead) -> None:
        """Add what another compile read."""
        for each in fields(self):
            own, other = getattr(self, each.name), getattr(others, each.name)
            own.extend(other) if isinstance(own, list) else own.update(other)
