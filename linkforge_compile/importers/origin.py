"""The head of an imported spec: the command that writes it again, and digests of what it was read from and of it."""

from __future__ import annotations

import os
import shlex
from collections.abc import Iterable, Mapping
from hashlib import sha256
from pathlib import Path
from types import MappingProxyType
from typing import NamedTuple

from linkforge_compile.source.characters import on_one_line

_FILES, _TEXT = "# sha256 of its files: ", "# sha256 of the rest: "


class Origin(NamedTuple):
    """What a spec was imported from; `digest` is the SHA-256 of the contents of all files read, one after another."""

    urdf: Path
    srdf: Path | None
    assignments: tuple[str, ...]
    """The arguments of xacros, as `NAME:=VALUE`."""
    digest: str
    packages: Mapping[str, Path] = MappingProxyType({})
    """The folders of packages that the user named."""
    is_outside_allowed: bool = False

    def with_head(self, text: str, spec: Path | None) -> str:
        """Return the text of a spec with its head; the command is to be run in the folder of the spec.

        None for the working directory.
        """
        folder = spec.parent if spec else Path()
        options = [*(("--srdf", relative_path(folder, self.srdf)) if self.srdf else ())]
        for name, place in self.packages.items():
            options += ("--package", f"{name}={relative_path(folder, place)}")
        options += ["--allow-outside"] if self.is_outside_allowed else []
        options += ("-o", spec.name) if spec else ()
        command = ("linkforge", "import", relative_path(folder, self.urdf), *self.assignments, *options)
        own = digest_of([text.encode()])
        return f"# {on_one_line(shlex.join(command))}\n{_FILES}{self.digest}\n{_TEXT}{own}\n\n{text}"


class Head(NamedTuple):
    """The head of an imported spec: the words after `linkforge import`, and the digest of the files it was read from.

    `is_edited` is whether the text below is another one than was imported.
    """

    words: tuple[str, ...]
    digest: str
    is_edited: bool


def read_head(text: str) -> Head | None:
    """Return the head of a spec, None if it has none."""
    head, _, body = text.replace("\r\n", "\n").partition("\n\n")
    match head.split("\n"):
        case [command, files, own] if files.startswith(_FILES) and own.startswith(_TEXT):
            try:
                program, name, *words = shlex.split(command.removeprefix("# "))
            except ValueError:
                return None
            if (program, name) != ("linkforge", "import"):
                return None
            is_edited = own.removeprefix(_TEXT) != digest_of([body.encode()])
            return Head(tuple(words), files.removeprefix(_FILES), is_edited)
    return None


def digest_of(contents: Iterable[bytes]) -> str:
    """Return the SHA-256 of contents, one after another: for one file, what `sha256sum` prints."""
    digest = sha256()
    for content in contents:
        digest.update(content)
    return digest.hexdigest()


def relative_path(folder: Path, file: Path) -> str:
    """Return the path of a file from a folder."""
    try:
        return Path(os.path.relpath(file, folder)).as_posix()
    except ValueError:  # another drive of Windows
        return file.absolute().as_posix()
