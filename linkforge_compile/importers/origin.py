"""The head of an imported spec: the command that writes it again, and a digest of the files that it was read from."""

from __future__ import annotations

import os
import shlex
from collections.abc import Iterable, Mapping
from hashlib import sha256
from pathlib import Path
from types import MappingProxyType
from typing import NamedTuple

from linkforge_compile.source.characters import on_one_line


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

    def head(self, spec: Path | None) -> str:
        """Return the comment for a spec, in whose folder the command is to be run; None for the working directory."""
        folder = spec.parent if spec else Path()
        options = [*(("--srdf", _from(folder, self.srdf)) if self.srdf else ())]
        for name, place in self.packages.items():
            options += ("--package", f"{name}={_from(folder, place)}")
        options += ["--allow-outside"] if self.is_outside_allowed else []
        options += ("-o", spec.name) if spec else ()
        command = ("linkforge", "import", _from(folder, self.urdf), *self.assignments, *options)
        return f"# {on_one_line(shlex.join(command))}\n# sha256 of its files: {self.digest}\n\n"


def digest_of(contents: Iterable[bytes]) -> str:
    """Return the SHA-256 of contents, one after another: for one file, what `sha256sum` prints."""
    digest = sha256()
    for content in contents:
        digest.update(content)
    return digest.hexdigest()


def _from(folder: Path, file: Path) -> str:
    try:
        return Path(os.path.relpath(file, folder)).as_posix()
    except ValueError:  # another drive of Windows
        return file.absolute().as_posix()
