"""Read spec, XML and data files, each once per compile, within the roots that the user allows."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, TypeAlias

from linkforge_compile.compilation import Compilation
from linkforge_compile.diagnostics import Diagnostic, Diagnostics, Note, notes_of
from linkforge_compile.diagnostics.codes.modules import NO_SUCH_FILE, OUTSIDE_ROOTS, UNREADABLE_FILE
from linkforge_compile.diagnostics.suggest import nearest
from linkforge_compile.limits import MAX_FILE_BYTES, Budget, Limit
from linkforge_compile.load.files_read import FilesRead
from linkforge_compile.load.spec_tree import ComposedFile, Place, cached_source, compose, follow_includes, read_tree
from linkforge_compile.paths import NearbyPackages, Package, as_typed, names_in, searched_note
from linkforge_compile.roots import ANYWHERE, Roots, exists, identity
from linkforge_compile.source import SourceFile, Span, place_of_byte
from linkforge_compile.source.characters import UnreadableError, begins_xml
from linkforge_compile.source.provenance import uses_in
from linkforge_compile.source.read_file import read_text
from linkforge_compile.syntax import Tags, YamlMap, YamlNode, YamlScalar, read_data
from linkforge_compile.syntax.parser import IGNORE_WORDS, suppressions_in

if TYPE_CHECKING:
    from linkforge_compile.diagnostics.reports import Suppression

_PACKAGE_SCHEME = "package://"
_FOR_EVERY_RUN = (
    "to allow it in every run, set ROS_PACKAGE_PATH to the folder that has the folder of package '{name}' in it; "
    "in CMake, write PACKAGES {name}=FOLDER"
)

_CHECK_BUDGETS = 3
"""How many budgets `check_spec` may spend; the largest robot is checked twice with its SRDF."""


@dataclass(frozen=True, eq=False)
class SpecFile:
    """One validated spec file and how it was reached; one file may be reached in several ways.

    `folder` is where its relative paths start, with symbolic links as written; None for a text without a folder.
    `package` is the package through whose `package://` it was reached; what it uses from there keeps it.
    `included` are the files merged into the tree. `packages` are package folders that using files declare.
    `renamed` are the names of a URDF's parts in the tree, by those in the URDF, where they differ.
    """

    file: SourceFile
    tree: YamlMap
    folder: Path | None
    package: Package | None = None
    included: Mapping[SourceFile, SpecFile] = field(default_factory=dict)
    packages: Mapping[str, Path] = field(default_factory=dict)
    renamed: Mapping[str, str] = field(default_factory=dict)

    def part_at(self, where: Span) -> SpecFile:
        """Return the included file that holds a place, or this one: relative paths written there start in it."""
        return self.included.get(where.file, self)


@dataclass(frozen=True)
class ImportSite:
    """The text that names a file and its place, None if it was named on the command line or in Python."""

    text: str
    where: Span | None


CheckSpec: TypeAlias = Callable[[SpecFile, "Loader"], Compilation]
"""Compiles a spec by itself and returns its errors."""


class Loader:
    """All files of one compile."""

    def __init__(
        self,
        packages: Mapping[str, Path] | None = None,
        roots: Roots = ANYWHERE,
        budget: Budget | None = None,
        buffers: Mapping[str, str] = MappingProxyType({}),
        known_sources: dict[Place, SourceFile] | None = None,
    ) -> None:
        """Create a loader without files.

        `packages` come before every other place where `package://` is looked for. Files that a spec names must lie
        within the `roots`, files that the user names may lie anywhere. `check_spec` finds the errors of a vendor's
        robot; the pipeline sets it, because later stages do the work. Without `runs_xacro` no xacro file is expanded.
        `buffers` are texts that are read instead of files, by real path. `known_sources` are those of an earlier
        compile, which are used again for the same text at the same place, and receive those of this one.
        """
        self.packages = dict(packages or {})
        self.roots = roots
        self.check_spec: CheckSpec = lambda _spec, _loader: Compilation(None, ())
        self.runs_xacro = True
        self._buffers = buffers
        self.nearby_packages: NearbyPackages = {}
        self.budget = budget or Budget()
        self._check_budget = Budget(times=_CHECK_BUDGETS, within=self.budget.within)
        self._known_sources = known_sources
        self.files_read = FilesRead()

    @property
    def sources(self) -> tuple[SourceFile, ...]:
        """The texts in the order read; a file that is included twice is there twice."""
        return tuple(self.files_read.sources)

    @property
    def files(self) -> tuple[Path, ...]:
        """The files in the order read, as the user would type them."""
        sources = (source.path for source in self.files_read.sources if source.path)
        return tuple(dict.fromkeys((*sources, *self.files_read.by_xacro)))

    @property
    def unread(self) -> tuple[Path, ...]:
        """The files that were requested but do not exist or are not text, in that order."""
        return tuple(dict.fromkeys(self.files_read.unread))

    @property
    def named_files_outside(self) -> frozenset[Path]:
        """The files that may be read only because the user names them, in values too, of which most name nothing."""
        inside = replace(self.roots, files=frozenset())
        return frozenset(path for path in self.roots.files if exists(path) and not inside.hold(path))

    @property
    def suppressions(self) -> tuple[Suppression, ...]:
        """The comments that suppress codes, of all files read."""
        commented = [file for file in self.sources if IGNORE_WORDS.search(file.text)]
        return tuple(one for file in commented for one in suppressions_in(file, self.budget))

    def parse(self, text: str, name: str, folder: Path | None, sink: Diagnostics) -> SpecFile | None:
        """Read a spec or URDF given as text; `folder` is where its relative paths start, None for none."""
        source = self._add_source(name, text, None, None)
        composed = _read_urdf(source, sink) if begins_xml(text) else self._compose(source, folder, sink)
        return _reach(composed, folder, None) if composed else None

    def open(
        self, path: Path, sink: Diagnostics, *, package: Package | None = None, used: ImportSite | None = None
    ) -> SpecFile | None:
        """Read a spec or URDF file; `used` is the `use` that names it, None for the compiled file.

        Returns None if it cannot be read, which is reported at the `use`, or is not a spec, reported in the file.
        """
        real = identity(path)
        specs = self.files_read.specs
        if real not in specs:
            is_urdf = path.suffix.lower() == ".urdf"
            source = self._read(path, used, sink)
            if source is None:
                return None
            # A file that is used twice is read once; its faults are reported with the first use.
            inside = with_use_trace(sink, (used.where if used else None,))
            specs[real] = (
                _read_urdf(source, inside)
                if is_urdf or begins_xml(source.text)
                else self._compose(source, path.parent, inside)
            )
        composed = specs[real]
        return _reach(composed, path.parent, package) if composed else None

    def open_xml(self, path: Path, sink: Diagnostics, used: ImportSite | None = None) -> SourceFile | None:
        """Read an XML file in the encoding that it declares; `used` names it, None for the command line."""
        real = identity(path)
        xml = self.files_read.xml
        if real not in xml:
            source = self._read(path, used, sink)
            if source is None:
                return None
            xml[real] = source
        return xml[real]

    def open_text(self, path: Path, sink: Diagnostics) -> SourceFile | None:
        """Read the text of a file that the command line names; None after a reported error."""
        return self._read(path, None, sink)

    def open_data(self, path: Path, sink: Diagnostics, tags: Tags, used: ImportSite) -> YamlNode | None:
        """Read a YAML file of any shape that may hold `tags`; None after a reported error."""
        real = identity(path)
        data = self.files_read.data
        if real not in data:
            source = self._read(path, used, sink)
            if source is None:
                return None
            inside = AnnotatingSink(sink, [Note("read here", used.where)])
            data[real] = read_data(source, inside, tags, self.budget)
        return data[real]

    def add_xml(self, name: str, text: str) -> SourceFile:
        """Add XML text that is not a file, or was read from a pipe."""
        return self._add_source(name, text, None, None)

    def add_read_by_xacro(self, path: Path) -> None:
        """Record a file that the xacro process read, for `files`."""
        self.files_read.by_xacro.append(as_typed(path))

    @contextmanager
    def separate_budget(self) -> Iterator[None]:
        """Charge `check_spec` to a budget of its own, since the spec is expanded again for the robot."""
        own, self.budget = self.budget, self._check_budget
        try:
            yield
        finally:
            self.budget = own

    def may_read(self, path: Path, used: ImportSite, sink: Diagnostics) -> bool:
        """Whether the namer of a file may read it; reports why not, whether or not the file exists."""
        if used.where is None or self.roots.hold(path):
            return True
        notes, name = [*map(Note, self.roots.reasons(path))], "NAME"
        if used.text.startswith(_PACKAGE_SCHEME):
            name = used.text.removeprefix(_PACKAGE_SCHEME).partition("/")[0]
            notes.append(Note(_FOR_EVERY_RUN.format(name=name)))
        sink.report(OUTSIDE_ROOTS.at(used.where, path=used.text, name=name, notes=notes))
        return False

    def _read(
        self, path: Path, used: ImportSite | None, sink: Diagnostics, included: Span | None = None
    ) -> SourceFile | None:
        """Read the text of a file; None after a reported error."""
        used = used or ImportSite(str(as_typed(path)), None)
        if not self.may_read(path, used, sink):
            return None
        try:
            # A pipe is fine if the user names it; one that an untrusted spec names would block the compile.
            text = self._buffers.get(identity(path)) if self._buffers else None
            if text is None:
                text = read_text(path, MAX_FILE_BYTES, only_regular=used.where is not None)
        except UnreadableError as error:
            byte = place_of_byte(error.undecoded, str(as_typed(path))) if error.undecoded else None
            notes = [Note("the byte is here", byte)] if byte and used.where else []
            sink.report(UNREADABLE_FILE.at(used.where or byte, path=used.text, reason=error, notes=notes))
            self.files_read.unread.append(as_typed(path))
            return None
        if text is None:
            notes = [searched_note(path, used.text, used.where)] if used.where else []
            user = used.where.file.path if used.where else None
            near = [name for name in names_in(path.parent) if _may_be(name, path.name) and path.with_name(name) != user]
            sink.report(NO_SUCH_FILE.at(used.where, path=used.text, name=path.name, near=near, notes=notes))
            self.files_read.unread.append(as_typed(path))
            return None
        return self._add_source(str(as_typed(path)), text, as_typed(path), used.where, included)

    def _add_source(
        self, name: str, text: str, path: Path | None, used: Span | None, included: Span | None = None
    ) -> SourceFile:
        self.budget.spend(Limit.CHARACTERS_READ, len(text), used)
        source = cached_source(SourceFile(name, text, path, order=len(self.files_read.sources), included=included))
        if self._known_sources is not None:
            source = _same_source(source, self._known_sources)
        self.files_read.sources.append(source)
        return source

    def _compose(self, source: SourceFile, folder: Path | None, sink: Diagnostics) -> ComposedFile | None:
        """Read a spec with all that it includes; None if its own text is not a spec."""
        tree = read_tree(source, sink, self.budget)
        if tree is None:
            return None
        if tree.get("include") is None:
            return ComposedFile(source, tree)

        def read_included(path: Path, item: YamlScalar) -> tuple[SourceFile, YamlMap] | None:
            file = self._read(path, ImportSite(item.text, item.span), sink, included=item.span)
            part = read_tree(file, sink, self.budget) if file else None
            return (file, part) if file and part is not None else None

        return compose(source, tree, folder, read_included, sink)


def _same_source(source: SourceFile, known: dict[Place, SourceFile]) -> SourceFile:
    """Return the known source if it has the same text at the same place; else the new one, which is known from now."""
    earlier = known.get(source.place)
    if earlier is None or not earlier.has_text_of(source):
        earlier = known[source.place] = source
    return earlier


def _may_be(file: str, name: str) -> bool:
    """Whether a file is a suggestion for a missing name: names that have only their endings in common are not alike."""
    (stem, *endings), (missing, *others) = file.lower().split("."), name.lower().split(".")
    return ("srdf" in endings) == ("srdf" in others) and nearest(missing, [stem]) is not None


def _read_urdf(source: SourceFile, sink: Diagnostics) -> ComposedFile | None:
    """Read a URDF as a spec; its faults are reported in the URDF."""
    from linkforge_compile.importers.urdf import read_urdf

    imported = read_urdf(source, sink)
    return ComposedFile(source, imported.tree, renamed=imported.renamed) if imported else None


def _reach(composed: ComposedFile, folder: Path | None, package: Package | None) -> SpecFile:
    """Return a spec as reached in a folder, and its included files as reached from there."""
    included = {}
    for file, include_paths in composed.include_paths.items():
        path = follow_includes(folder or Path(), include_paths)
        inside = package if package is not None and path.is_relative_to(package.folder) else None
        included[file] = SpecFile(file, composed.tree, path.parent, inside)
    return SpecFile(composed.file, composed.tree, folder, package, included, renamed=composed.renamed)


class AnnotatingSink(Diagnostics):
    """Pass each diagnostic on to another sink, with notes appended to its own."""

    def __init__(self, sink: Diagnostics, notes: Iterable[Note]) -> None:
        super().__init__()
        self._sink = sink
        self._notes = tuple(notes)

    def report(self, diagnostic: Diagnostic) -> None:
        self._sink.report(replace(diagnostic, notes=(*diagnostic.notes, *self._notes)))


def with_use_trace(sink: Diagnostics, uses: Iterable[Span | None]) -> Diagnostics:
    """Return a sink for a file that is reached through these uses, the innermost first; None is no use."""
    notes = notes_of(uses_in(use for use in uses if use is not None))
    return AnnotatingSink(sink, notes) if notes else sink
