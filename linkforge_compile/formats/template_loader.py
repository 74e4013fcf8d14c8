"""Reads the templates of a user's folder, and ours where it has none of that name."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from itertools import islice
from pathlib import Path

from jinja2 import Environment, FileSystemLoader
from jinja2.loaders import split_template_path

from linkforge_compile.formats.environment import is_xml
from linkforge_compile.formats.xml_text import is_writable
from linkforge_compile.limits import MAX_FILE_BYTES
from linkforge_compile.resources import templates_folder
from linkforge_compile.roots import Roots, exists, is_file
from linkforge_compile.source import SourceFile, Span, place_of_byte

_MOST_NAMES = 1000
"""Templates of a folder that a suggestion may name."""


class OutsideError(Exception):
    """A template, or what one includes, is reached by a link that leads out of the folders that may be read."""

    def __init__(self, path: Path, roots: Roots) -> None:
        self.path, self.roots = path, roots
        super().__init__(str(path))


class UnreadableError(Exception):
    """There is a file for a template, and no text in it; `place` is what is wrong in it, else its beginning."""

    def __init__(self, path: Path, reason: str, place: Span | None = None) -> None:
        self.path, self.reason, self.place = path, reason, place or SourceFile(str(path), "", path).whole
        super().__init__(reason)


class FolderLoader(FileSystemLoader):
    """Loads templates from a user's folder, else from ours.

    `files` are those that were read, by their paths, and `missing` those of the folder that were looked for in vain.
    """

    def __init__(self, folder: Path, roots: Roots) -> None:
        super().__init__(templates_folder())
        self.files: dict[str, SourceFile] = {}
        self.missing: list[Path] = []
        self.folder, self._roots = folder, roots

    def get_source(self, environment: Environment, template: str) -> tuple[str, str, Callable[[], bool]]:
        """Return the text of a template and its path.

        Raises:
            TemplateNotFound: for one that neither folder has, and for a name with `..` in it.
            OutsideError: for a link that leads out of the folders that may be read.
            UnreadableError: for a file without text.

        """
        path = self.folder.joinpath(*split_template_path(template))
        if not self._roots.hold(path):
            raise OutsideError(path, self._roots)
        if is_file(path):
            text, name = self.read(path), str(path)
            if is_xml(template) and not is_writable(text):
                raise UnreadableError(path, "it contains a character that XML does not allow")
        elif os.path.islink(path) and not exists(path):  # noqa: PTH114 it answers for what may not be looked at
            self.missing.append(path)
            raise UnreadableError(path, "the link is broken: its target does not exist")
        else:
            self.missing.append(path)
            text, name, _ = super().get_source(environment, template)
        self.files[name] = SourceFile(name, text, Path(name))
        return text, name, lambda: True

    def read(self, path: Path) -> str:
        """Return the text of a template of the folder.

        Raises:
            OutsideError: for a link that leads out of the folders that may be read.
            UnreadableError: for a file without text.

        """
        if not self._roots.hold(path):
            raise OutsideError(path, self._roots)
        return _text(path)

    def place_of(self, template: str) -> Span:
        """Return the place of a template as a whole; of one of ours, that of the first of the folder that it uses."""
        path = self.folder / template
        in_folder = () if os.path.lexists(path) else (file for file in self.files.values() if self.has(file))
        file = self.files.get(str(path)) or next(iter(in_folder), None) or SourceFile(str(path), "", path)
        return file.whole

    def place_of_line(self, template: str, line: str) -> Span:
        """Return the line of a template that reads so; the place of the whole where none does, or several do."""
        whole = self.place_of(template)
        numbers = [number for number, text in enumerate(whole.file.lines, 1) if text.strip() == line]
        return span_of_line(whole.file, numbers[0]) if line and len(numbers) == 1 else whole

    def has(self, file: SourceFile) -> bool:
        """Whether a file lies in the user's folder, and is none of ours."""
        return file.path is not None and file.path.is_relative_to(self.folder)

    def names(self) -> Iterator[str]:
        """Yield what a template may include, by its path in its folder."""
        for folder in (self.folder, templates_folder()):
            found = (path.relative_to(folder).as_posix() for path in folder.rglob("*.j2"))
            yield from islice(found, _MOST_NAMES)


def span_of_line(file: SourceFile, number: int) -> Span:
    """Return the text of a line; Jinja2 reports no columns."""
    text = file.line(number)
    begin = len(text) - len(text.lstrip()) + 1
    return Span(file, number, begin, number, max(begin, len(text.rstrip()) + 1))


def _text(path: Path) -> str:
    try:
        with path.open("rb") as file:
            content = file.read(MAX_FILE_BYTES + 1)
    except OSError as error:
        raise UnreadableError(path, str(error.strerror).lower()) from None
    if len(content) > MAX_FILE_BYTES:
        raise UnreadableError(path, f"it is larger than {MAX_FILE_BYTES // 1024**2} MiB")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        byte = error.object[error.start]
        place = place_of_byte(error, str(path))
        raise UnreadableError(path, f"the byte {byte:#04x} is not UTF-8; save it as UTF-8", place) from None
