"""Answer the questions of the xacro process: where a package is, and whether a file may be read."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from linkforge_compile.paths import folders_for_xacro
from linkforge_compile.roots import Roots, is_file


class XacroAnswers:
    """Answers the questions of one file, `main`, and records what it may not have.

    `declared` are the package folders that the user or the spec names.
    """

    def __init__(self, main: Path, declared: Mapping[str, Path], roots: Roots) -> None:
        self._main, self._declared, self._roots = main, declared, roots
        self._folders: dict[str, list[Path]] = {}
        """The folders of each package in the order in which they are tried."""
        self.missing_packages: list[str] = []
        self.refused: list[Path] = []
        """Files outside of the roots."""

    def find(self, name: str) -> Path | None:
        """Return the folder of a package, None if it is not found."""
        if name not in self._folders:
            found = folders_for_xacro(name, self._declared, self._main.parent, self._roots)
            self._folders[name] = list(dict.fromkeys(folder.absolute() for folder in found))
        if not self._folders[name]:
            self.missing_packages.append(name)
        return next(iter(self._folders[name]), None)

    @property
    def packages(self) -> dict[str, Path]:
        """The folders of the packages that were found."""
        return {name: folders[0] for name, folders in self._folders.items() if folders}

    def may_read(self, path: Path) -> bool:
        """Whether a file or folder may be read."""
        # The loader has read the file itself already.
        is_allowed = path == self._main.absolute() or self._roots.hold(path)
        if not is_allowed:
            self.refused.append(path)
        return is_allowed

    def change_package(self, missing: Path) -> bool:
        """Give up the folder of a package that lacks a file if another folder of the package has it."""
        for folders in self._folders.values():
            if folders and missing.is_relative_to(folders[0]):
                inside = missing.relative_to(folders[0])
                others = [folder for folder in folders[1:] if self._roots.hold(folder / inside)]
                if having := next((folder for folder in others if is_file(folder / inside)), None):
                    del folders[: folders.index(having)]
                    return True
        return False
