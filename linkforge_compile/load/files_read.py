"""The files that a compile has read so far, and what became of each."""

from __future__ import annotations

from copy import copy
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import Any

from linkforge_compile.load.spec_tree import ComposedFile
from linkforge_compile.source import SourceFile
from linkforge_compile.syntax import YamlNode


@dataclass
class FilesRead:
    """Lists in the order read, paths as their user would type them, and mappings by real path.

    A file that is included twice is twice in `sources`. The files of `unread` and `unread_meshes` were requested, but
    do not exist or cannot be read. `meshes` has what `lower` made of those that an inertia is computed from.
    """

    sources: list[SourceFile] = field(default_factory=list)
    specs: dict[str, ComposedFile | None] = field(default_factory=dict)
    data: dict[str, YamlNode | None] = field(default_factory=dict)
    xml: dict[str, SourceFile] = field(default_factory=dict)
    by_xacro: list[Path] = field(default_factory=list)
    unread: list[Path] = field(default_factory=list)
    meshes: dict[str, object] = field(default_factory=dict)
    mesh_files: list[Path] = field(default_factory=list)
    unread_meshes: list[Path] = field(default_factory=list)

    def copy(self) -> FilesRead:
        return FilesRead(*(copy(getattr(self, each.name)) for each in fields(self)))

    def since(self, before: FilesRead) -> FilesRead:
        """Return what was added since `before` was copied."""
        added: list[Any] = []  # each field has a type of its own
        for each in fields(self):
            now, then = getattr(self, each.name), getattr(before, each.name)
            is_list = isinstance(now, list)
            added.append(now[len(then) :] if is_list else {key: now[key] for key in now.keys() - then.keys()})
        return FilesRead(*added)

    def add(self, others: FilesRead) -> None:
        """Add what another compile read."""
        for each in fields(self):
            own, other = getattr(self, each.name), getattr(others, each.name)
            own.extend(other) if isinstance(own, list) else own.update(other)
