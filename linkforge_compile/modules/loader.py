"""Reads spec files, each once in a compile, and remembers how each was reached."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import islice
from pathlib import Path

from linkforge_compile.diagnostics import Diagnostics, Note
from linkforge_compile.diagnostics.codes.modules import NO_SUCH_FILE, UNREADABLE_FILE
from linkforge_compile.modules.file_text import UnreadableError, file_text
from linkforge_compile.modules.packages import Package
from linkforge_compile.schema import validate
from linkforge_compile.source import SourceFile, Span
from linkforge_compile.syntax import YamlMap, read

_MAX_NEAR_NAMES = 10_000


@dataclass(frozen=True, slots=True, eq=False)
class SpecFile:
    """One file, read and validated, and how it was reached; two of one `file` are two ways to it.

    `folder` is where its relative paths start, with symbolic links as they were walked; None for a text that
    lies nowhere. `package` is the one through whose `package://` it was reached, and all that it uses from there.
    """

    file: SourceFile
    tree: YamlMap
    folder: Path | None
    package: Package | None = None


@dataclass(frozen=True, slots=True)
class Used:
    """The text that names a file and where it stands, None for what is named on the command line or in Python."""

    text: str
    where: Span | None


class Loader:
    """All the files of one compile."""

    def __init__(self, packages: Mapping[str, Path] | None = None) -> None:
        """`packages` come before every other place where `package://` is looked for."""
        self.packages = dict(packages or {})
        self._sources: list[SourceFile] = []
        self._trees: dict[str, tuple[SourceFile, YamlMap | None]] = {}  # by real path

    @property
    def files(self) -> tuple[Path, ...]:
        """Every file that was read, in that order, as its user would type it."""
        return tuple(source.path for source in self._sources if source.path)

    def parse(self, text: str, name: str, folder: Path | None, sink: Diagnostics) -> SpecFile | None:
        """Read a spec from text that is no file; `folder` is where its relative paths start, None for nowhere."""
        source = self._source(name, text, None)
        tree = _tree(source, sink)
        return SpecFile(source, tree, folder) if tree else None

    def open(
        self, path: Path, sink: Diagnostics, *, package: Package | None = None, used: Used | None = None
    ) -> SpecFile | None:
        """Read a spec file; `used` says by which `use`, None for the compiled file.

        None where it cannot be read, which is reported at the `use`, or is no spec, which is reported inside it.
        """
        # Paths are compared by what they lead to and shown as they were reached.
        real = os.path.realpath(path)
        if real not in self._trees:
            text = _text(path, used or Used(str(_as_typed(path)), None), sink)
            if text is None:
                return None
            source = self._source(str(_as_typed(path)), text, _as_typed(path))
            self._trees[real] = source, _tree(source, sink)
        source, tree = self._trees[real]
        return SpecFile(source, tree, path.parent, package) if tree else None

    def _source(self, name: str, text: str, path: Path | None) -> SourceFile:
        source = SourceFile(name, text, path, order=len(self._sources))
        self._sources.append(source)
        return source


def follow(folder: Path, target: str) -> Path:
    """Return where a relative path leads from a folder, in the shortest form that leads there too.

    `a/..` is nowhere else but here, unless `a` is a symbolic link.
    """
    for part in Path(target).parts:
        back = part == ".." and folder.name not in ("", "..") and not folder.is_symlink()
        folder = folder.parent if back else folder / part
    return folder


def _tree(source: SourceFile, sink: Diagnostics) -> YamlMap | None:
    tree = read(source, sink)
    return validate(tree, sink) if tree is not None else None


def _as_typed(path: Path) -> Path:
    """Return the path as a person in the working directory would type it: relative where it lies below."""
    here = Path.cwd()
    return path.relative_to(here) if path.is_relative_to(here) else path


def _text(path: Path, used: Used, sink: Diagnostics) -> str | None:
    # Whoever compiles a pipe named it himself; a `use` of one may be a stranger's, and would make us wait.
    try:
        text = file_text(path, only_regular=used.where is not None)
    except UnreadableError as error:
        sink.report(UNREADABLE_FILE.at(used.where, path=used.text, reason=error))
        return None
    if text is None:
        notes = [Note(f"looked for it at {_as_typed(path)}")] if used.where else []
        near = _neighbours(path)
        sink.report(NO_SUCH_FILE.at(used.where, path=used.text, name=path.name, near=near, notes=notes))
    return text


def _neighbours(path: Path) -> tuple[str, ...]:
    try:
        return tuple(entry.name for entry in islice(path.parent.iterdir(), _MAX_NEAR_NAMES))
    except OSError:
        return ()
