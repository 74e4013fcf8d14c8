"""Folders of robots: finds the specs of a repository, and writes the files of a new robot."""

from __future__ import annotations

import json
import os
import re
import textwrap
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path, PurePath

from linkforge_compile.roots import Roots, exists, identity, is_file

SPEC_ENDINGS = (".robot.yaml", ".robot.yml")

MAX_SPECS = 200
"""An editor reads the schema of this many specs without noticeable delay."""

MAX_FOLDERS = 20_000

_MODELINE = re.compile(r"(?:\s*#.*\n)*?\s*#\s*(?:yaml-language-server:.*)?\$schema\s*[:=]")
"""Comments at the top of a file, one of which names its schema."""

_OUTPUT_FOLDERS = frozenset({"build", "install", "log", "node_modules", "__pycache__"})
"""Folders that tools write; colcon copies specs into some of them."""

NAME = re.compile(r"[A-Za-z][A-Za-z0-9_-]*")
"""A name of a robot that files and a CMake project can have too."""

SCHEMA = PurePath(".linkforge", "robot.schema.json")
"""The default path of a repository's schema."""

_SPEC, _CMAKE, _PRE_COMMIT, _GITIGNORE = "{name}.robot.yaml", "CMakeLists.txt", ".pre-commit-config.yaml", ".gitignore"
_SETTINGS, _EXTENSIONS, _TASKS = ".vscode/settings.json", ".vscode/extensions.json", ".vscode/tasks.json"

_TEMPLATES = {
    _SPEC: "robot.robot.yaml",
    _CMAKE: "CMakeLists.txt",
    _GITIGNORE: "gitignore",
    _PRE_COMMIT: "pre-commit-config.yaml",
    _SETTINGS: "settings.json",
    _EXTENSIONS: "extensions.json",
    _TASKS: "tasks.json",
}

_FIND = "find_package(linkforge_compile REQUIRED)"


class TooManyFilesError(Exception):
    """There are more specs or folders than a repository of robots has; the message says how many."""


def find_specs(
    root: Path,
    at_most: int = MAX_SPECS,
    *,
    roots: Roots | None = None,
    unread: Callable[[OSError], object] | None = None,
    outside: Callable[[Path], object] | None = None,
) -> tuple[Path, ...]:
    """Return the specs in a folder and below, sorted, except in hidden, linked and output folders.

    Left out are links to specs that are found anyway, pipes, devices, and links that lead out of `roots` (default:
    those around the folder), because an untrusted repository must not name files of its user. `unread` is called with
    the error of each folder that cannot be read, `outside` with each such link.

    Raises:
        TooManyFilesError: There are more than `at_most` specs or MAX_FOLDERS folders.

    """
    roots = roots or Roots.around(root)
    found: list[Path] = []
    for spec in _walk(root, unread):
        # Checked before the file is touched, so that nothing is revealed about a file outside.
        if roots.are_left_by(spec):
            if outside is not None:
                outside(spec)
            continue
        if exists(spec) and not is_file(spec):  # a pipe or device, for which a reader may wait
            continue
        found.append(spec)
        if len(found) > at_most:
            raise TooManyFilesError(f"more than {at_most} specs")
    files = {identity(spec) for spec in found if not spec.is_symlink()}
    return tuple(sorted(spec for spec in found if not spec.is_symlink() or _is_another(spec, files)))


def _is_another(link: Path, files: set[str]) -> bool:
    """Whether a link leads to a file that is not in `files`; the lock of an editor is a link that leads nowhere."""
    return is_file(link) and identity(link) not in files


def folders_of_specs(root: Path) -> tuple[Path, ...]:
    """Return the folders that `find_specs` searches, the root first.

    Raises:
        TooManyFilesError: There are more than MAX_FOLDERS folders.

    """
    return tuple(folder for folder, _ in _walk_folders(root, None))


def _walk(root: Path, unread: Callable[[OSError], object] | None) -> Iterator[Path]:
    for folder, files in _walk_folders(root, unread):
        yield from (folder / name for name in files if name.endswith(SPEC_ENDINGS) and not name.startswith("."))


def _walk_folders(root: Path, unread: Callable[[OSError], object] | None) -> Iterator[tuple[Path, list[str]]]:
    """Yield each folder with the names of the files in it."""
    for number, (folder, inner, files) in enumerate(os.walk(root, onerror=unread), start=1):
        if number > MAX_FOLDERS:
            raise TooManyFilesError(f"more than {MAX_FOLDERS} folders")
        # os.walk does not enter what is removed here.
        inner[:] = sorted(name for name in inner if not name.startswith(".") and name not in _OUTPUT_FOLDERS)
        yield Path(folder), files


@dataclass(frozen=True)
class RobotFolder:
    """The folder of a new robot, and the folders at or above it with files that several robots share.

    `workspace` has the schema, `package` the CMakeLists.txt, and `repository` is the top of the git repository, or
    the folder itself without one.
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

    @property
    def folders(self) -> tuple[Path, ...]:
        """All folders in which files may be written."""
        return self.folder, self.workspace, self.package, self.repository

    def files(self, name: str) -> dict[Path, str]:
        """Return the text of each file to write by its path, without the schema.

        A file that several robots share is included if it belongs into the folder itself, or if tools read it only at
        the top of the repository and it does not exist.
        """
        texts = self._texts(name)
        homes = {path: self._folder_of(path) for path in texts}
        return {
            homes[path] / path.format(name=name): text
            for path, text in texts.items()
            if text and (homes[path] == self.folder or (path in _AT_TOP and not (homes[path] / path).exists()))
        }

    def _texts(self, name: str) -> dict[str, str]:
        from linkforge_compile.formats.environment import render_own

        values = {
            "name": name,
            "schema": _relative(self.folder, self.workspace / SCHEMA),
            "find": _FIND,
            "add_robot": self._add_robot(name),
            "folder": _prefix(self.repository, self.folder),
            "yaml_schemas": self._yaml_schemas(),
        }
        texts = {path: render_own(f"init/{template}.j2", values) for path, template in _TEMPLATES.items()}
        ignored = self._ignored_above()
        lines = [line for line in texts[_GITIGNORE].splitlines(keepends=True) if line.strip().strip("/") not in ignored]
        return {**texts, _GITIGNORE: "".join(lines)}

    def _ignored_above(self) -> set[str]:
        """Return the names that a .gitignore above the workspace ignores in every folder."""
        files = (above / _GITIGNORE for above in _up_to(self.workspace, ".git"))
        texts = (path.read_text("utf-8", "replace") for path in files if path.is_file())
        lines = (line.strip() for text in texts for line in text.splitlines())
        return {line.removeprefix("**/").rstrip("/") for line in lines if not line.startswith("/")}

    def _folder_of(self, path: str) -> Path:
        folders = {_SPEC: self.folder, _CMAKE: self.package, _GITIGNORE: self.workspace}
        return folders.get(path, self.repository)

    def _add_robot(self, name: str) -> str:
        from linkforge_compile.formats import FORMATS

        spec = _relative(self.package, self.folder / _SPEC.format(name=name))
        formats = " ".join(one.name for one in FORMATS if one.is_default)
        return f"linkforge_add_robot({spec} FORMATS {formats} INSTALL)"

    def _yaml_schemas(self) -> str:
        below = _prefix(self.repository, self.workspace)
        patterns = [f"{below}**/*.robot.{ending}" if below else f"*.robot.{ending}" for ending in ("yaml", "yml")]
        return f'"yaml.schemas": {json.dumps({f"{below}{SCHEMA.as_posix()}": patterns}, ensure_ascii=False)}'

    def missing(self, name: str) -> dict[Path, tuple[str, ...]]:
        """Return the lines about the robot that existing files lack."""
        finders: dict[str, Callable[[str, str], list[str]]] = {
            _CMAKE: _missing_cmake,
            _PRE_COMMIT: _missing_hooks,
            _GITIGNORE: _missing_patterns,
            _SETTINGS: self._missing_settings,
            _EXTENSIONS: _missing_extensions,
            _TASKS: _missing_tasks,
        }
        texts = self._texts(name)
        homes = {self._folder_of(path) / path: path for path in finders}
        found = {path: path.read_text("utf-8", "replace") for path in homes if path.is_file()}
        missing = {path: tuple(finders[homes[path]](text, texts[homes[path]])) for path, text in found.items()}
        return {path: lines for path, lines in missing.items() if lines}

    def _missing_settings(self, found: str, _text: str) -> list[str]:
        schema = f"{_prefix(self.repository, self.workspace)}{SCHEMA.as_posix()}"
        return [] if f'"{schema}"' in found or f'"./{schema}"' in found else [self._yaml_schemas()]


_AT_TOP = (_PRE_COMMIT, _SETTINGS, _EXTENSIONS, _TASKS)
"""Files that tools read only at the top of a repository."""


def _missing_cmake(found: str, text: str) -> list[str]:
    # A line of the user's own may have other options.
    return [line for line in text.splitlines()[-2:] if line.partition(" FORMATS")[0] not in found]


def _missing_hooks(found: str, text: str) -> list[str]:
    block = text.partition("repos:\n")[2]
    return [] if "id: linkforge-check" in found else textwrap.dedent(block).splitlines()


def _missing_patterns(found: str, text: str) -> list[str]:
    there = {line.strip().strip("/") for line in found.splitlines()}
    return [line for line in text.splitlines() if line.strip("/") not in there]


def _missing_extensions(found: str, text: str) -> list[str]:
    return [] if "redhat.vscode-yaml" in found else [line.strip() for line in text.splitlines()[1:-1]]


def _missing_tasks(found: str, text: str) -> list[str]:
    # The first one, which shows the others' form.
    task = text.partition('"tasks": [\n')[2].partition("\n    },")[0]
    return [] if '"linkforge"' in found else textwrap.dedent(f"{task}\n    }}").splitlines()


def workspace_of(folder: Path) -> Path:
    """Return the nearest folder at or above one, within its repository, that has a schema; else the folder itself."""
    return next((one for one in (folder, *_up_to(folder, ".git")) if (one / SCHEMA).is_file()), folder)


def _up_to(folder: Path, *markers: str) -> tuple[Path, ...]:
    """Return the folders above one, up to the first with a marker; () if the folder has one itself, or none has."""
    places = (folder.absolute(), *folder.absolute().parents)
    held = (number for number, one in enumerate(places) if any((one / marker).exists() for marker in markers))
    above = places[1 : next(held, 0) + 1]
    return above if folder.is_absolute() else tuple(Path(os.path.relpath(one)) for one in above)


def has_editor_schema(file: Path) -> bool:
    """Whether editors know the schema of a file: by its name, or by a comment at its top."""
    if file.name.endswith(SPEC_ENDINGS):
        return True
    try:
        text = file.read_text("utf-8", "replace") if is_file(file) else ""
    except OSError:
        return False
    return _MODELINE.match(text) is not None


def schemas_below(root: Path, specs: Iterable[Path]) -> tuple[Path, ...]:
    """Return the folders between `root` and its specs that have a schema of their own."""
    between = {folder for spec in specs for folder in spec.parents if folder != root and folder.is_relative_to(root)}
    return tuple(sorted(folder for folder in between if (folder / SCHEMA).is_file()))


def _prefix(start: Path, folder: Path) -> str:
    """Return the prefix that turns a path relative to the folder into one relative to the start; "" for the same."""
    path = _relative(start, folder)
    return "" if path == "." else f"{path}/"


def _relative(start: Path, path: Path) -> str:
    return Path(os.path.relpath(path, start)).as_posix()
