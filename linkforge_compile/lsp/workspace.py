"""The open buffers of an editor, and the latest Analysis of each spec that they belong to.

A buffer is compiled as a spec of its own. A part without a name, which other specs include, is compiled with those of
them that are in the folders of the workspace.
"""

from __future__ import annotations

import os
from collections.abc import Container, Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

from lsprotocol import types

from linkforge_compile.analysis import Analysis, Settings, analyse_path
from linkforge_compile.diagnostics.codes.schema import MISSING_NAME
from linkforge_compile.editor.folders import SPEC_ENDINGS, TooManyFilesError, find_specs
from linkforge_compile.expand import Unset
from linkforge_compile.lsp.convert import Columns
from linkforge_compile.lsp.module_entries import unused_files
from linkforge_compile.roots import identity
from linkforge_compile.source import Position, SourceFile, Span
from linkforge_compile.source.characters import UnreadableError
from linkforge_compile.source.read_file import read_text

_MAX_BYTES = 1024 * 1024
"""The largest file that is searched for the names of others."""


class Buffer(NamedTuple):
    """An open text: the path and version as the editor gives them, and its content."""

    path: Path
    version: int | None
    file: SourceFile


class Document(NamedTuple):
    """What a feature sees of an open buffer: its text, and the analyses of the specs that read it, its own first.

    `readable` is the latest analysis in which the text parsed.
    """

    path: Path
    file: SourceFile
    analyses: tuple[Analysis, ...]
    columns: Columns
    readable: Analysis | None = None

    @property
    def analysis(self) -> Analysis | None:
        """The analysis of the spec that the text is or belongs to."""
        return self.analyses[0] if self.analyses else None

    @property
    def is_malformed(self) -> bool:
        """Whether the text does not parse, so that what is known of it is from an earlier one."""
        return self.analysis is None or not _parsed(self.analysis, identity(self.path))

    def place(self, at: types.Position) -> Position:
        """Return the place of a position of the protocol in this text."""
        return self.columns.place(self.file, at)

    def holds(self, span: Span) -> bool:
        """Whether a place is in this text."""
        return span.file.path is not None and identity(span.file.path) == identity(self.path)


@dataclass
class Workspace:
    """All that the server knows. `generation` counts the changes of texts, so that older results can be told apart."""

    packages: Mapping[str, Path] = field(default_factory=dict)
    buffers: dict[str, Buffer] = field(default_factory=dict)
    """The open buffers by real path."""
    analyses: dict[str, Analysis] = field(default_factory=dict)
    """The latest analysis of each spec by real path."""
    readable: dict[str, Analysis] = field(default_factory=dict)
    """The latest analysis in which each buffer parsed, by its real path."""
    generation: int = 0
    _stale: set[str] = field(default_factory=set)
    _includers: dict[str, tuple[Path, ...]] = field(default_factory=dict)
    _changed: dict[str, set[str]] = field(default_factory=dict)
    """The files that changed since the analysis of a spec began, for those being analysed, by real path."""

    def put(self, path: Path, version: int | None, text: str) -> None:
        """Open a buffer, or replace its text."""
        real = identity(path)
        self.buffers[real] = Buffer(path, version, SourceFile(str(path), text, path))
        self.note_change(path)
        if real not in self.analyses:
            self._stale.add(real)

    def close(self, path: Path) -> None:
        """Close a buffer: from now on its file is read."""
        real = identity(path)
        self.buffers.pop(real, None)
        self._includers.pop(real, None)
        self.note_change(path)
        self._forget_unneeded()

    def _forget_unneeded(self) -> None:
        """Forget the analyses of what is neither open nor a spec that includes what is."""
        needed = {*self.buffers, *(identity(root) for root in self.roots())}
        self.analyses = {root: analysis for root, analysis in self.analyses.items() if root in needed}
        self.readable = {real: analysis for real, analysis in self.readable.items() if real in self.buffers}
        self._stale &= needed

    def note_change(self, path: Path) -> bool:
        """Mark the specs that read a file, or looked for it, as to be analysed again; return whether there may be any.

        A spec that is being analysed may have read the file already.
        """
        real = identity(path)
        affected = {root for root, one in self.analyses.items() if real == root or _depends(one, {real})}
        self._stale |= affected
        for changed in self._changed.values():
            changed.add(real)
        if affected or real in self.buffers:
            self.generation += 1
        return bool(affected or self._changed)

    def roots(self) -> tuple[Path, ...]:
        """Return the specs to analyse: each buffer, or the specs that include it."""
        specs = ((real, buffer.path) for real, buffer in self.buffers.items() if is_spec(buffer.path))
        found = (self._includers.get(real) or (path,) for real, path in specs)
        return tuple({identity(path): path for paths in found for path in paths}.values())

    def pending_for(self, path: Path) -> tuple[Path, ...]:
        """Return those of the pending specs that are a file or read it, as far as that is known."""
        real = identity(path)
        others = {root for root, analysis in self.analyses.items() if root != real and not _reads(analysis, real)}
        return tuple(root for root in self.pending() if identity(root) not in others)

    def pending(self) -> tuple[Path, ...]:
        """Return the specs whose analysis is missing, older than a text, or not finished."""
        waiting = {*self._stale, *self._changed}
        return tuple(one for one in self.roots() if identity(one) in waiting or identity(one) not in self.analyses)

    def settings(self) -> Settings:
        """Return how specs are analysed now: as `linkforge check` does, with the buffers in place of their files."""
        texts = {real: buffer.file.text for real, buffer in self.buffers.items()}
        return Settings(packages=dict(self.packages), options={"gazebo": "gz"}, unset=Unset.NOTE, buffers=texts)

    @property
    def versions(self) -> dict[str, int | None]:
        """The versions of the open buffers by real path."""
        return {real: buffer.version for real, buffer in self.buffers.items()}

    def begin(self, path: Path) -> Settings:
        """Return the settings to analyse a spec with, which from now on is stale only by further changes."""
        self._stale.discard(identity(path))
        self._changed[identity(path)] = set()
        return self.settings()

    def keep(self, path: Path, analysis: Analysis, includers: Iterable[Path] = ()) -> None:
        """Keep the analysis of a spec; `includers` are the specs to analyse in its place if it is a part of them."""
        real = identity(path)
        self.analyses[real] = analysis
        if _depends(analysis, self._changed.pop(real, ())):
            self._stale.add(real)
        includers = tuple(includers)
        if includers:
            self._includers[real] = includers
        self._note_includes(path, analysis)
        for buffer in self.buffers:
            if (buffer == real or buffer in self._includers) and _parsed(analysis, buffer):
                self.readable[buffer] = analysis
        # An includer that was analysed before knows more of a part than the part alone.
        for includer in map(identity, includers):
            if includer in self.analyses and _parsed(self.analyses[includer], real):
                self.readable[real] = self.analyses[includer]
        self._forget_unneeded()

    def _note_includes(self, path: Path, analysis: Analysis) -> None:
        """Note of which open parts a spec is an includer, and of which it is none any more."""
        real = identity(path)
        for part in self.buffers:
            known = {identity(one): one for one in self._includers.get(part, ())}
            if part in self.analyses and is_part(self.analyses[part]) and _reads(analysis, part) and part != real:
                self._includers[part] = tuple({**known, real: path}.values())
            elif real in known and not _reads(analysis, part):
                del self._includers[part]
                self._stale.add(part)

    def document(self, path: Path, columns: Columns) -> Document | None:
        """Return what a feature sees of an open buffer; None if it is not open."""
        real = identity(path)
        buffer = self.buffers.get(real)
        if buffer is None:
            return None
        own = [self.analyses[real]] if real in self.analyses and real not in self._includers else []
        others = [one for root, one in self.analyses.items() if root != real and _reads(one, real)]
        return Document(buffer.path, buffer.file, (*own, *others), columns, self.readable.get(real))


def is_spec(path: Path) -> bool:
    """Whether a file is a spec by its name."""
    return os.fspath(path).endswith(SPEC_ENDINGS)


def is_part(analysis: Analysis) -> bool:
    """Whether a spec has no name, as a part that other specs include."""
    return any(one.code is MISSING_NAME for one in analysis.compilation.diagnostics)


def _depends(analysis: Analysis, files: Container[str]) -> bool:
    """Whether a spec read one of some files, or looked for it."""
    return any(identity(file) in files for file in (*analysis.compilation.files, *analysis.compilation.unread))


def _reads(analysis: Analysis, real: str) -> bool:
    return any(identity(file) == real for file in analysis.compilation.files)


def _parsed(analysis: Analysis, real: str) -> bool:
    """Whether a file is the spec or an included one, and was not malformed."""
    files = (analysis.spec.file, *analysis.spec.included) if analysis.spec and analysis.instance else ()
    return any(file.path is not None and identity(file.path) == real for file in files)


def find_users(path: Path, folders: Iterable[Path], settings: Settings) -> dict[Path, Analysis]:
    """Return the specs in folders that read a file, directly or through others, with their analyses.

    A spec reads a file also if it has it as a module under a condition that does not hold.
    """
    real = identity(path)
    others = (spec for spec in _mentioning(path, folders, settings.buffers) if identity(spec) != real)
    analyses = {spec: analyse_path(spec, settings) for spec in others}
    users: dict[Path, Analysis] = {}
    known, before = {real}, 0
    while len(known) > before:
        before = len(known)
        users = {spec: one for spec, one in analyses.items() if not known.isdisjoint(_files_of(one))}
        known |= {*map(identity, users)}
    return users


def _files_of(analysis: Analysis) -> set[str]:
    """Return the real paths of the files that a spec reads, or would read if all conditions held."""
    return {identity(file) for file in (*analysis.compilation.files, *unused_files(analysis.instance))}


def with_users(document: Document, folders: Iterable[Path], settings: Settings) -> Document:
    """Return a document with the analyses of the specs in folders that read it, with the text that it has here."""
    buffers = {**settings.buffers, identity(document.path): document.file.text}
    known = {identity(one.compilation.files[0]) for one in document.analyses if one.compilation.files}
    users = find_users(document.path, folders, settings._replace(buffers=buffers))
    others = (one for path, one in users.items() if identity(path) not in known)
    return document._replace(analyses=(*document.analyses, *others))


def _mentioning(path: Path, folders: Iterable[Path], buffers: Mapping[str, str]) -> list[Path]:
    """Return the specs that name a file, those that name these, and so on."""
    texts = {spec: _text(spec, buffers) for folder in folders for spec in specs_in(folder)}
    found: dict[Path, None] = {}
    names = [path.name]
    while names:
        name = names.pop()
        new = [spec for spec, text in texts.items() if name in text and spec not in found]
        found |= dict.fromkeys(new)
        names += [spec.name for spec in new]
    return list(found)


def specs_in(folder: Path) -> tuple[Path, ...]:
    """Return the specs in a folder; none if these are more than a repository of robots has."""
    try:
        return find_specs(folder)
    except TooManyFilesError:
        return ()


def _text(path: Path, buffers: Mapping[str, str]) -> str:
    known = buffers.get(identity(path))
    if known is not None:
        return known
    try:
        return read_text(path, _MAX_BYTES, only_regular=True) or ""
    except UnreadableError:
        return ""
