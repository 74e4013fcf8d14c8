"""Read the files of a xacro, and find what `$(find PACKAGE)` and relative paths in them name."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from contextlib import suppress
from functools import partial
from glob import glob
from itertools import takewhile
from pathlib import Path
from typing import Any

import yaml

from linkforge_compile.diagnostics import BeyondLimitError, Diagnostics
from linkforge_compile.expand.data_tags import UNIT_TAGS, number_with_tag, value_with_tag
from linkforge_compile.file_names import stem_of
from linkforge_compile.importers.origin import relative_path
from linkforge_compile.importers.xml import read_xml
from linkforge_compile.load import ImportSite, Loader
from linkforge_compile.migration.symbols import CannotTranslateError, MissingFileError, Parts
from linkforge_compile.paths import find_package, folders_for_xacro
from linkforge_compile.source import SourceFile
from linkforge_compile.source.xml_tree import XmlDocument
from linkforge_compile.syntax import Tags, read_data

_WILDCARDS = frozenset("*[?")


class Sources:
    """The files of one xacro, each parsed once, so that a macro that is included twice is one macro."""

    def __init__(
        self, main: Path, loader: Loader, sink: Diagnostics, spec_folder: Path | None = None, spec_stem: str = ""
    ) -> None:
        """`spec_folder` is that of the specs, in which their relative paths start; None for that of the file.

        `spec_stem` is the name of the robot's spec, without its ending; empty for that of the file.
        """
        self.main, self.loader, self.sink = main, loader, sink
        self.spec_folder, self.spec_stem = spec_folder or main.parent, spec_stem or stem_of(main)
        self._found: dict[str, Path] = {}
        self._documents: dict[Path, XmlDocument] = {}
        self._data: dict[Path, object] = {}

    @property
    def documents(self) -> Mapping[Path, XmlDocument]:
        """The files that were read."""
        return self._documents

    @property
    def data_files(self) -> tuple[Path, ...]:
        """The files of data that were read."""
        return tuple(self._data)

    @property
    def found(self) -> Collection[str]:
        """The packages that `$(find)` has named."""
        return self._found

    def open(self, path: Path) -> XmlDocument:
        """Return a file as elements.

        Raises:
            CannotTranslateError: if it cannot be read.

        """
        key = path.absolute()
        if key not in self._documents:
            site = ImportSite(str(path), None)
            file = self.loader.open_xml(path, self.sink, site)
            document = read_xml(file, self.sink) if file else None
            if document is None:
                raise CannotTranslateError(f"'{path}' cannot be read")
            self._documents[key] = document
        return self._documents[key]

    def find(self, package: str) -> Path:
        """Return the folder of a package."""
        declared, roots = self.loader.packages, self.loader.roots
        folder = next(folders_for_xacro(package, declared, self.main.parent, roots), None)
        if folder is None:
            raise MissingFileError(f"no package named '{package}'; pass --package {package}=FOLDER")
        self._found[package] = folder.absolute()
        return folder.absolute()

    def note_package(self, name: Parts) -> None:
        """Count a package among those found, if its name is known and it is there."""
        if len(name) == 1 and isinstance(name[0], str):
            with suppress(MissingFileError):
                self.find(name[0])

    @property
    def packages(self) -> dict[str, str]:
        """The packages that a spec does not find from its folder, each with its path from there."""
        loader, start = self.loader, self.spec_folder
        return {
            name: relative_path(start, folder)
            for name, folder in self._found.items()
            if find_package(name, loader.packages, start, loader.roots) is None
        }

    def included(self, path: str, folder: Path) -> Iterator[Path]:
        """Yield the files that an `<xacro:include>` names, of which relative paths start in a folder.

        Raises:
            CannotTranslateError: outside of what may be read, whether there is a file or not.

        """
        whole, roots = folder / path, self.loader.roots
        if not roots.hold(Path(*takewhile(lambda part: not set(part) & _WILDCARDS, whole.parts))):
            raise CannotTranslateError(f"'{path}' may not be read; see --allow-outside")
        if set(path) & _WILDCARDS:
            found = map(Path, sorted(glob(str(whole))))  # noqa: PTH207  # the pattern may be absolute
            yield from filter(roots.hold, found)
        else:
            yield whole

    def data(self, path: Path) -> Any:
        """Return the contents of a YAML file as xacro reads them."""
        key = path.absolute()
        if key not in self._data:
            if not self.loader.roots.hold(path):
                raise CannotTranslateError(f"'{path}' may not be read; see --allow-outside")
            try:
                self._data[key] = yaml.load(key.read_text("utf-8"), _DataLoader)
            except (OSError, UnicodeDecodeError, RecursionError, yaml.YAMLError) as error:
                raise CannotTranslateError(f"'{path}' cannot be read: {_reason(error)}") from None
        return self._data[key]

    def is_readable(self, path: Path) -> bool:
        """Whether a spec can read a file of data: it refuses keys that are written twice, for example."""
        sink = Diagnostics()
        tags: Tags = {tag: partial(number_with_tag, sink, tag) for tag in UNIT_TAGS}
        try:
            read_data(SourceFile(str(path), path.read_text("utf-8")), sink, tags)
        except BeyondLimitError as error:
            raise CannotTranslateError(f"'{path}' cannot be read: {error}") from None
        return not sink.has_errors


def _reason(error: Exception) -> str:
    """Return what is wrong with a file, on one line."""
    if isinstance(error, OSError):
        return error.strerror or type(error).__name__
    if isinstance(error, yaml.MarkedYAMLError) and error.problem_mark:
        return f"{error.problem} (line {error.problem_mark.line + 1}, column {error.problem_mark.column + 1})"
    return " ".join(str(error).split())


class _DataLoader(yaml.SafeLoader):
    """PyYAML's safe loader with the units of xacro."""


def _read_unit(loader: _DataLoader, node: yaml.ScalarNode) -> float:
    text = str(loader.construct_scalar(node))
    value = value_with_tag(node.tag, text, SourceFile(node.tag, text).whole)
    if value is None:
        raise yaml.MarkedYAMLError(problem=f"'{text}' after {node.tag} is not a number", problem_mark=node.start_mark)
    return value


for _tag in UNIT_TAGS:
    _DataLoader.add_constructor(_tag, _read_unit)
