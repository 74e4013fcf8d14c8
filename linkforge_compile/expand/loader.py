"""Reads spec files, each once in a compile, and remembers how each was reached."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Protocol, TypeAlias

from linkforge_compile.diagnostics import Diagnostic, Diagnostics, Note
from linkforge_compile.diagnostics.codes.modules import NO_SUCH_FILE, UNREADABLE_FILE
from linkforge_compile.diagnostics.codes.roots import OUTSIDE_ROOTS
from linkforge_compile.expand.file_text import UnreadableError, file_bytes, file_text, utf8_text
from linkforge_compile.expand.noted import NotedSink, used_from
from linkforge_compile.expand.path_starts import looked_for
from linkforge_compile.expand.paths import as_typed, names_in
from linkforge_compile.expand.trees import known_source, tree_of
from linkforge_compile.expand.whole import Whole, reached
from linkforge_compile.limits import MAX_FILE_BYTES, Budget, Limit
from linkforge_compile.roots import ANYWHERE, Roots, identity
from linkforge_compile.source import SourceFile, Span, place_of_byte
from linkforge_compile.source.encoding import EncodingError, begins_xml, xml_text
from linkforge_compile.syntax import Tags, YamlMap, YamlNode, YamlScalar, read_data
from linkforge_compile.syntax.ignore_comments import IGNORE_WORDS, ignore_comments

if TYPE_CHECKING:
    from linkforge_compile.diagnostics.ignores import Ignore
    from linkforge_compile.expand.packages import Package


@dataclass(frozen=True, eq=False)
class SpecFile:
    """One file, read and validated, and how it was reached; two of one `file` are two ways to it.

    `folder` is where its relative paths start, with symbolic links as they were walked; None for a text that
    lies nowhere. `package` is the one through whose `package://` it was reached, and all that it uses from there.
    `included` are the files that were laid into the tree, each as if it stood by itself. `packages` are folders of
    packages that the files around declare, for what they hand on and for formats that cannot declare any.
    """

    file: SourceFile
    tree: YamlMap
    folder: Path | None
    package: Package | None = None
    included: Mapping[SourceFile, SpecFile] = field(default_factory=dict)
    packages: Mapping[str, Path] = field(default_factory=dict)

    def writer(self, where: Span) -> SpecFile:
        """Return the one of the files that are this one in which a place lies: its relative paths start there."""
        return self.included.get(where.file, self)


@dataclass(frozen=True)
class Used:
    """The text that names a file and where it stands, None for what is named on the command line or in Python."""

    text: str
    where: Span | None


class _ReadText(Protocol):
    def __call__(self, path: Path, *, only_regular: bool) -> str | None: ...


Judge: TypeAlias = Callable[[SpecFile, "Loader"], tuple[Diagnostic, ...]]
"""Tells the errors of a spec by itself."""


def _nothing_wrong(_spec: SpecFile, _loader: Loader) -> tuple[Diagnostic, ...]:
    return ()


_TIMES_JUDGED = 3
"""How many times what a compile may take its judges may take: the largest robot is judged twice with its SRDF."""


_PACKAGE = "package://"


class Loader:
    """All the files of one compile."""

    def __init__(
        self, packages: Mapping[str, Path] | None = None, roots: Roots = ANYWHERE, budget: Budget | None = None
    ) -> None:
        """`packages` come before every other place where `package://` is looked for.

        What a spec names is read within the `roots`, what its user names wherever it is. `judge` is asked of a
        vendor's robot what is wrong with it, for that is a matter of later stages. Without `runs_xacro` no xacro file
        is expanded, as where the environment forbids it.
        """
        self.packages = dict(packages or {})
        self.roots = roots
        self.judge: Judge = _nothing_wrong
        self.runs_xacro = True
        self.packages_around: dict[Path, Mapping[str, Path]] = {}
        """The packages near a folder by their names, once somebody asked; nothing that a spec names is read there."""
        self._sources: list[SourceFile] = []
        self._specs: dict[str, Whole | None] = {}  # by real path
        self._data: dict[str, YamlNode | None] = {}  # by real path
        self._xml: dict[str, SourceFile] = {}  # by real path
        self._read_elsewhere: list[Path] = []
        self._unread: list[Path] = []
        self.budget = budget or Budget()
        self._budget_of_judges = Budget(times=_TIMES_JUDGED, within=self.budget.within)

    @property
    def sources(self) -> tuple[SourceFile, ...]:
        """The text of everything that was read, in that order; a file that is included twice is there twice."""
        return tuple(self._sources)

    @property
    def files(self) -> tuple[Path, ...]:
        """Every file that was read, in that order, as its user would type it."""
        sources = (source.path for source in self._sources if source.path)
        return tuple(dict.fromkeys((*sources, *self._read_elsewhere)))

    @property
    def unread(self) -> tuple[Path, ...]:
        """Every file that was asked for and is not there, or is no text, in that order."""
        return tuple(dict.fromkeys(self._unread))

    @property
    def ignores(self) -> tuple[Ignore, ...]:
        """Every comment of what was read that asks to ignore codes."""
        asking = [file for file in self.sources if IGNORE_WORDS.search(file.text)]
        if not asking:
            return ()
        return tuple(one for file in asking for one in ignore_comments(file, self.budget))

    def parse(self, text: str, name: str, folder: Path | None, sink: Diagnostics) -> SpecFile | None:
        """Read a spec from text that is no file, or a URDF as one.

        `folder` is where its relative paths start, None for nowhere.
        """
        source = self._source(name, text, None, None)
        whole = _urdf(source, sink) if begins_xml(text) else self._whole(source, folder, sink)
        return _spec(whole, folder, None) if whole else None

    def open(
        self, path: Path, sink: Diagnostics, *, package: Package | None = None, used: Used | None = None
    ) -> SpecFile | None:
        """Read a spec file, or a URDF as one; `used` says by which `use`, None for the compiled file.

        None where it cannot be read, which is reported at the `use`, or is no spec, which is reported inside it.
        """
        # Paths are compared by what they lead to and shown as they were reached.
        real = identity(path)
        if real not in self._specs:
            is_urdf = path.suffix.lower() == ".urdf"
            text = self._text(path, used or Used(str(as_typed(path)), None), sink, _xml_text if is_urdf else _spec_text)
            if text is None:
                return None
            source = self._source(str(as_typed(path)), text, as_typed(path), used.where if used else None)
            # A file that is used twice is read once: what is wrong in it is told with its first use.
            inside = used_from(sink, (used.where,) if used and used.where else ())
            self._specs[real] = (
                _urdf(source, inside) if is_urdf or begins_xml(text) else self._whole(source, path.parent, inside)
            )
        whole = self._specs[real]
        return _spec(whole, path.parent, package) if whole else None

    def open_xml(self, path: Path, sink: Diagnostics, used: Used | None = None) -> SourceFile | None:
        """Read a text of XML in the encoding that it says; `used` says by what, None for the command line."""
        real = identity(path)
        if real not in self._xml:
            text = self._text(path, used or Used(str(as_typed(path)), None), sink, _xml_text)
            if text is None:
                return None
            self._xml[real] = self._source(str(as_typed(path)), text, as_typed(path), used.where if used else None)
        return self._xml[real]

    def given_xml(self, name: str, text: str) -> SourceFile:
        """Take a text of XML that is no file, or was read from a pipe."""
        return self._source(name, text, None, None)

    def note_read(self, path: Path) -> None:
        """Note that somebody else read a file for this compile; what it holds is his."""
        self._read_elsewhere.append(as_typed(path))

    def open_data(self, path: Path, sink: Diagnostics, tags: Tags, used: Used) -> YamlNode | None:
        """Read a file of data, which may be of any shape and hold `tags`; None where it cannot be had, as reported."""
        real = identity(path)
        if real not in self._data:
            text = self._text(path, used, sink)
            if text is None:
                return None
            source = self._source(str(as_typed(path)), text, as_typed(path), used.where)
            notes = [Note("read here", used.where)]
            self._data[real] = read_data(source, NotedSink(sink, notes), tags, self.budget)
        return self._data[real]

    @contextmanager
    def judging(self) -> Iterator[None]:
        """Count what is taken meanwhile apart: a robot that is judged by itself is expanded once more for the rest."""
        own, self.budget = self.budget, self._budget_of_judges
        try:
            yield
        finally:
            self.budget = own

    def may_read(self, path: Path, used: Used, sink: Diagnostics) -> bool:
        """Whether a file may be read by whoever names it; reports why not, be there a file or not."""
        if used.where is None or self.roots.hold(path):
            return True
        notes = map(Note, self.roots.reasons(path))
        name = used.text.removeprefix(_PACKAGE).partition("/")[0] if used.text.startswith(_PACKAGE) else "NAME"
        sink.report(OUTSIDE_ROOTS.at(used.where, path=used.text, name=name, notes=notes))
        return False

    def _text(self, path: Path, used: Used, sink: Diagnostics, read: _ReadText = file_text) -> str | None:
        if not self.may_read(path, used, sink):
            return None
        # Whoever compiles a pipe named it himself; a `use` of one may be a stranger's, and would make us wait.
        try:
            text = read(path, only_regular=used.where is not None)
        except UnreadableError as error:
            byte = place_of_byte(error.undecoded, str(as_typed(path))) if error.undecoded else None
            notes = [Note("the byte is here", byte)] if byte and used.where else []
            sink.report(UNREADABLE_FILE.at(used.where or byte, path=used.text, reason=error, notes=notes))
            self._unread.append(as_typed(path))
            return None
        if text is None:
            notes = [looked_for(path, used.text, used.where)] if used.where else []
            near = [name for name in names_in(path.parent) if _is_srdf(name) == _is_srdf(path.name)]
            sink.report(NO_SUCH_FILE.at(used.where, path=used.text, name=path.name, near=near, notes=notes))
            self._unread.append(as_typed(path))
        return text

    def _whole(self, source: SourceFile, folder: Path | None, sink: Diagnostics) -> Whole | None:
        """Read a spec with all that it includes; None where its own text is no spec."""
        tree = tree_of(source, sink, self.budget)
        if tree is None:
            return None
        if tree.get("include") is None:
            return Whole(source, tree)
        from linkforge_compile.expand.includes import lay_together

        def read_included(path: Path, item: YamlScalar) -> tuple[SourceFile, YamlMap] | None:
            text = self._text(path, Used(item.text, item.span), sink)
            if text is None:
                return None
            included = self._source(str(as_typed(path)), text, as_typed(path), item.span, included=item.span)
            part = tree_of(included, sink, self.budget)
            return None if part is None else (included, part)

        return lay_together(source, tree, folder, read_included, sink)

    def _source(
        self, name: str, text: str, path: Path | None, asked: Span | None, included: Span | None = None
    ) -> SourceFile:
        self.budget.spend(Limit.CHARACTERS_READ, len(text), asked)
        source = known_source(SourceFile(name, text, path, order=len(self._sources), included=included))
        self._sources.append(source)
        return source


def _is_srdf(name: str) -> bool:
    return ".srdf" in name.lower()


def _urdf(source: SourceFile, sink: Diagnostics) -> Whole | None:
    """Read a URDF as a spec; what is wrong with it is told where it has it."""
    from linkforge_compile.importers.urdf import read_urdf

    imported = read_urdf(source, sink)
    return Whole(source, imported.tree) if imported else None


def _spec(whole: Whole, folder: Path | None, package: Package | None) -> SpecFile:
    """Return a spec as it was reached in a folder, and its included files from there."""
    included = {}
    for file, way in whole.ways.items():
        path = reached(folder or Path(), way)
        inside = package if package is not None and path.is_relative_to(package.folder) else None
        included[file] = SpecFile(file, whole.tree, path.parent, inside)
    return SpecFile(whole.file, whole.tree, folder, package, included)


def _spec_text(path: Path, *, only_regular: bool) -> str | None:
    content = file_bytes(path, MAX_FILE_BYTES, only_regular=only_regular)
    if content is None:
        return None
    return _decoded_xml(content) if begins_xml(content) else utf8_text(content)


def _xml_text(path: Path, *, only_regular: bool) -> str | None:
    content = file_bytes(path, MAX_FILE_BYTES, only_regular=only_regular)
    return None if content is None else _decoded_xml(content)


def _decoded_xml(content: bytes) -> str:
    try:
        return xml_text(content)
    except EncodingError as error:
        raise UnreadableError(str(error), error.undecoded) from error
