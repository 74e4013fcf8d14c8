"""The files of a new robot: a first spec, and what editors, git, pre-commit and CMake want beside it."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable
from pathlib import Path, PurePath

from linkforge_compile.frozen import dataclass
from linkforge_compile.resources import templates_folder

NAME = re.compile(r"[A-Za-z][A-Za-z0-9_-]*")
"""What a robot may be called whose name is that of files and of a CMake project as well."""

SCHEMA = PurePath(".linkforge", "robot.schema.json")
"""Where the schema of a repository lies in it, unless said."""

_SPEC, _CMAKE, _PRE_COMMIT = "{name}.robot.yaml", "CMakeLists.txt", ".pre-commit-config.yaml"

_TEMPLATES = {
    _SPEC: "robot.robot.yaml",
    _CMAKE: "CMakeLists.txt",
    ".gitignore": "gitignore",
    _PRE_COMMIT: "pre-commit-config.yaml",
    ".vscode/settings.json": "settings.json",
    ".vscode/extensions.json": "extensions.json",
}

_FIND = "find_package(linkforge_compile REQUIRED)"


@dataclass(frozen=True, slots=True)
class RobotFolder:
    """Where a new robot goes, and the folders at or above that which have what stands once for all robots below.

    `workspace` has the schema, `package` the CMakeLists.txt, `repository` is that of git, the folder itself for none.
    """

    folder: Path
    workspace: Path
    package: Path
    repository: Path

    @classmethod
    def at(cls, folder: Path) -> RobotFolder:
        builders = (folder, *_up_to(folder, "package.xml", ".git"))
        package = next((one for one in builders if (one / _CMAKE).is_file()), folder)
        *_, repository = (folder, *_up_to(folder, ".git"))
        return cls(folder, workspace_of(folder), package, repository)

    def files(self, name: str) -> dict[Path, str]:
        """Return the text of each file by its path; the schema that the spec names is not among them."""
        from jinja2 import Environment, FileSystemLoader, StrictUndefined

        # Nothing is escaped: the name is letters, digits, `_` and `-`, and no file is XML.
        environment = Environment(
            loader=FileSystemLoader(templates_folder() / "init"), undefined=StrictUndefined, keep_trailing_newline=True
        )
        words = {"name": name, "schema": _way(self.folder, self.workspace / SCHEMA), "find": _FIND}
        words["add_robot"] = self._add_robot(name)
        return {
            self.folder / path.format(name=name): environment.get_template(f"{template}.j2").render(words)
            for path, template in _TEMPLATES.items()
            if self._goes_here(path)
        }

    def _goes_here(self, path: str) -> bool:
        home = {_SPEC: self.folder, _CMAKE: self.package, _PRE_COMMIT: self.repository}
        return home.get(path, self.workspace) == self.folder

    def _add_robot(self, name: str) -> str:
        spec = _way(self.package, self.folder / _SPEC.format(name=name))
        return f"linkforge_add_robot({spec} FORMATS urdf srdf INSTALL)"

    def missing(self, name: str) -> dict[Path, tuple[str, ...]]:
        """Return the lines that files which were there before lack of the robot."""
        wanted = {
            self.package / _CMAKE: (_FIND, self._add_robot(name)),
            self.repository / _PRE_COMMIT: ("- id: linkforge-check",),
        }
        found = {path: path.read_text("utf-8", "replace") for path in wanted if path.is_file()}
        # Whoever wrote a line himself may have given it other options.
        missed = {
            path: tuple(line for line in wanted[path] if line.partition(" FORMATS")[0] not in text)
            for path, text in found.items()
        }
        return {path: lines for path, lines in missed.items() if lines}


def workspace_of(folder: Path) -> Path:
    """Return the folder at or above one, in its repository, that has a schema; else the folder itself."""
    return next((one for one in (folder, *_up_to(folder, ".git")) if (one / SCHEMA).is_file()), folder)


def _up_to(folder: Path, *markers: str) -> tuple[Path, ...]:
    """Return the folders above one up to the first that holds a marker; none where it does itself, or none does."""
    places = (folder.absolute(), *folder.absolute().parents)
    held = (number for number, one in enumerate(places) if any((one / marker).exists() for marker in markers))
    above = places[1 : next(held, 0) + 1]
    return above if folder.is_absolute() else tuple(Path(os.path.relpath(one)) for one in above)


def schemas_below(root: Path, specs: Iterable[Path]) -> tuple[Path, ...]:
    """Return the folders between one and its specs that have a schema of their own, which editors read there."""
    between = {folder for spec in specs for folder in spec.parents if folder != root and folder.is_relative_to(root)}
    return tuple(sorted(folder for folder in between if (folder / SCHEMA).is_file()))


def _way(start: Path, path: Path) -> str:
    return Path(os.path.relpath(path, start)).as_posix()
